#ifndef eunoe_source_simulation_insertion_obstacles_h
#define eunoe_source_simulation_insertion_obstacles_h

#include <eunoe/solids/solid.h>

#include <vector>

namespace eunoe {

/// Solids and walls at rest that push spheres out of themselves, as springs of unit stiffness do.
class Obstacles
{
public:
  explicit Obstacles(std::vector<Solid> solids) : solids(std::move(solids)) {}

  /// Finds the facets that spheres may touch until they have moved by @p skin (m).
  /// @param begin, end the spheres that will be asked for
  void search(const std::vector<Vec3> &positions, const std::vector<double> &radii,
              std::size_t begin, std::size_t end, double skin);

  /// Force (m) on the k-th sphere of those searched for.
  /// @param overlap (m) raised to the largest
  Vec3 push(std::size_t k, const Vec3 &centre, double radius, double &overlap) const;

private:
  /// Facets of a solid close to a sphere.
  struct Near
  {
    std::size_t solid;
    std::vector<std::int32_t> facets;
  };

  const std::vector<Solid> solids;
  std::vector<std::vector<Near>> near; ///< of each sphere
};

} // namespace eunoe

#endif
