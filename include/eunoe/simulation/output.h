#ifndef eunoe_simulation_output_h
#define eunoe_simulation_output_h

#include <eunoe/solids/solid.h>
#include <eunoe/state/particle_arrays.h>
#include <eunoe/state/particle_field.h>

#include <cstdint>
#include <mpi.h>
#include <string>
#include <vector>

namespace dealii {
template <int dim, int spacedim>
class DataOutInterface;
}

namespace eunoe {

/// Data of particles for one picture.
struct PictureField
{
  std::string name;
  unsigned int n_components;  ///< 3 for a vector
  std::vector<double> values; ///< `[particle * n_components + component]`, of owned particles
};

/// Whole numbers for one picture, such as ids, which its single precision would round.
struct PictureIntegers
{
  std::string name;
  std::vector<std::int64_t> values; ///< one per point of this rank
};

/// A series of .vtu files with their exact times in a .pvd file, for ParaView. Without a folder
/// nothing is written.
class PictureSeries
{
public:
  /// @param name of the .pvd file and beginning of the names of the .vtu files
  PictureSeries(const std::string &folder, const std::string &name, MPI_Comm comm)
      : folder(folder), name(name), comm(comm)
  {
  }

  /// Writes the owned particles of all ranks; collective. Throws a UserError on every rank if a
  /// file cannot be written, like all that follows.
  /// @param fields of the extra doubles
  /// @param more further data of the particles
  void write(double time, const ParticleArrays &particles, const ParticleFields &fields,
             const std::vector<PictureField> &more = {});

  /// Writes what all ranks together draw with deal.II, cells or lines; collective.
  ///@{
  void write(double time, dealii::DataOutInterface<3, 3> &cells);
  void write(double time, dealii::DataOutInterface<1, 3> &lines,
             const std::vector<PictureIntegers> &integers = {});
  ///@}

  /// Writes the surfaces of those solids that are drawn; collective.
  void write(double time, const std::vector<Solid> &solids);

  /// Times (s) and names of the files so far.
  using Files = std::vector<std::pair<double, std::string>>;
  const Files &get_files() const { return files; }
  /// Waits until what this rank wrote since the last call would survive a crash of its machine.
  /// Throws a UserError on a rank that cannot.
  void sync();
  /// Goes on behind the files of an interrupted run; later ones disappear from the .pvd file.
  void resume(const Files &earlier);

private:
  template <int dim>
  void write_in_parallel(double time, dealii::DataOutInterface<dim, 3> &data,
                         const std::vector<PictureIntegers> &integers);
  std::string next_file(double time);
  void write_index() const;

  const std::string folder, name;
  MPI_Comm comm;
  Files files;
  std::size_t n_synced = 0;
};

} // namespace eunoe

#endif
