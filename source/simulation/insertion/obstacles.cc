#include "obstacles.h"

#include <array>

namespace eunoe {

void Obstacles::search(const std::vector<Vec3> &positions, const std::vector<double> &radii,
                       const std::size_t begin, const std::size_t end, const double skin)
{
  near.assign(end - begin, {});
  for (std::size_t s = 0; s < solids.size(); ++s) {
    const Box box = solids[s].shape->bounding_box();
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 centre = solids[s].to_own_frame(positions[k]);
      const double reach = radii[k] + skin;
      std::vector<std::int32_t> facets;
      if (box.contains(centre, reach))
        solids[s].shape->find_facets(centre, reach, facets);
      if (!facets.empty())
        near[k - begin].push_back({s, std::move(facets)});
    }
  }
}

Vec3 Obstacles::push(const std::size_t k, const Vec3 &centre, const double radius,
                     double &overlap) const
{
  Vec3 force;
  std::array<SurfaceContact, Shape::max_contacts> found;
  for (const Near &candidate : near[k]) {
    const Solid &solid = solids[candidate.solid];
    const std::int32_t *const first = candidate.facets.data();
    const unsigned int n =
        solid.shape->find_contacts(solid.to_own_frame(centre), radius, radius, first,
                                   first + candidate.facets.size(), found.data());
    for (unsigned int c = 0; c < n; ++c) {
      const double depth = radius - found[c].distance;
      overlap = std::max(overlap, depth);
      force -= depth * solid.to_space(found[c].normal);
    }
  }
  return force;
}

} // namespace eunoe
