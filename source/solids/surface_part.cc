#include <eunoe/solids/surface_part.h>

#include <limits>

namespace eunoe {

SurfacePart::SurfacePart(std::shared_ptr<const TriangulatedSurface> whole, const int number,
                         std::shared_ptr<const std::vector<int>> part_of)
    : whole(std::move(whole)), number(number), part_of(std::move(part_of))
{
  box = Box::around(triangles());
}

std::vector<Vec3> SurfacePart::triangles() const
{
  const std::vector<Vec3> all = whole->triangles();
  std::vector<Vec3> mine;
  for (std::size_t t = 0; t < part_of->size(); ++t)
    if (is_mine(static_cast<std::int32_t>(t)))
      mine.insert(mine.end(), all.begin() + 3 * t, all.begin() + 3 * (t + 1));
  return mine;
}

double SurfacePart::find_facets(const Vec3 &centre, const double reach,
                                std::vector<std::int32_t> &facets) const
{
  const std::size_t first = facets.size();
  const double distance = whole->find_facets(centre, reach, facets);
  for (std::size_t k = first; k < facets.size(); ++k)
    if (is_mine(facets[k]))
      return distance;
  facets.resize(first);
  return std::numeric_limits<double>::infinity();
}

unsigned int SurfacePart::find_contacts(const Vec3 &centre, const double radius, const double reach,
                                        const std::int32_t *begin, const std::int32_t *end,
                                        SurfaceContact *contacts) const
{
  std::array<std::int32_t, max_contacts> owners;
  const unsigned int n_all =
      whole->find_contacts(centre, radius, reach, {begin, end}, contacts, owners.data());
  unsigned int n = 0;
  for (unsigned int k = 0; k < n_all; ++k)
    if (is_mine(owners[k]))
      contacts[n++] = contacts[k];
  return n;
}

} // namespace eunoe
