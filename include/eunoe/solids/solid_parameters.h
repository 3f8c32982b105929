#ifndef eunoe_solids_solid_parameters_h
#define eunoe_solids_solid_parameters_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/solids/motion_section.h>
#include <eunoe/solids/placement.h>
#include <eunoe/solids/solid.h>
#include <eunoe/solids/triangulated_surface.h>

#include <mpi.h>

namespace eunoe {

/// `wall i` of `subsection floating walls`: an infinite plane that acts for a while.
struct FloatingWall
{
  Vec3 point, normal = {1., 0., 0.};
  double start = 0., end = 0.;
};

struct FloatingWallParameters : public ParameterSection
{
  std::vector<FloatingWall> walls;

  explicit FloatingWallParameters(unsigned int n = 0) : walls(n) {}

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;

  std::vector<Solid> make(int material) const;
};

/// `solid object i` of `subsection solid objects / solid surfaces`.
struct SolidObject
{
  std::string type = "gmsh";
  std::string file = "none";
  std::string shape = "plane";
  std::string arguments = "0,0,0 : 1,0,0 : 0,0,1";
  unsigned int refinement = 0; ///< of a generator of deal.II
  bool simplex = true;
  Placement placement;
  Vec3 centre;
  bool output = true;
  std::map<std::string, std::shared_ptr<MotionSection>> motions = solid_motions().make_all();

  /// The motion that the entries ask for, or rest. Throws a std::invalid_argument with sentences.
  /// @param time_step with which velocities are integrated (s)
  std::shared_ptr<const Motion> make_motion(double time_step) const;
};

struct SolidObjectParameters : public ParameterSection
{
  std::vector<SolidObject> objects;

  explicit SolidObjectParameters(unsigned int n = 0) : objects(n) {}

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;

  /// Reads or makes the surfaces; collective. What is wrong with one goes to @p problems.
  /// @param time_step with which the prescribed velocities are integrated (s)
  std::vector<Solid> make(int material, double time_step, MPI_Comm comm, Problems &problems) const;
};

/// Triangles of a Gmsh file, read on one rank and given to all; collective.
TriangleMesh read_gmsh(const std::string &file, MPI_Comm comm);

/// A surface of one of deal.II's generators, each cell of which is cut into four @p refinement
/// times. Throws std::invalid_argument.
TriangleMesh generate_surface(const std::string &type, const std::string &arguments,
                              unsigned int refinement);

} // namespace eunoe

#endif
