#ifndef eunoe_processes_heap_standing_height_h
#define eunoe_processes_heap_standing_height_h

#include <cstddef>
#include <mpi.h>
#include <vector>

namespace eunoe::heap {

/// How high powder stands, on any number of ranks. Centres of grains that touch are no farther
/// apart than the largest diameter, so what is above a layer of that height without any centre
/// flies, or hangs somewhere.
class StandingHeight
{
public:
  /// @param highest centres that are higher do not count (m)
  /// @param diameter of the largest grains (m)
  StandingHeight(double highest, double diameter)
      : thickness(margin * diameter), occupied(static_cast<std::size_t>(highest / thickness) + 2, 0)
  {
  }

  /// @param height of a grain's centre (m)
  void see(double height)
  {
    const double layer = height / thickness;
    if (layer >= 0. && layer < static_cast<double>(occupied.size()))
      occupied[static_cast<std::size_t>(layer)] = 1;
  }

  void reduce(MPI_Comm comm)
  {
    MPI_Allreduce(MPI_IN_PLACE, occupied.data(), static_cast<int>(occupied.size()), MPI_SIGNED_CHAR,
                  MPI_MAX, comm);
  }

  /// Above all centres of what stands (m).
  double operator()() const
  {
    std::size_t layer = 0;
    while (layer < occupied.size() && occupied[layer] != 0)
      ++layer;
    return thickness * static_cast<double>(layer);
  }

private:
  static constexpr double margin = 1.01; ///< for what attracts each other across a gap

  const double thickness;
  std::vector<signed char> occupied;
};

} // namespace eunoe::heap

#endif
