#include <eunoe/domain/cell_locator.h>
#include <eunoe/domain/mesh.h>
#include <eunoe/solids/box_tree.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace eunoe {

CellLocator::CellLocator(const Domain &domain) : periods(domain.periods())
{
  constexpr double most = std::numeric_limits<double>::max();
  around = {{most, most, most}, {-most, -most, -most}};
  std::vector<std::pair<Box, std::int32_t>> boxes;
  for (const auto &cell : domain.mesh().triangulation.active_cell_iterators()) {
    if (!cell->is_locally_owned())
      continue;
    Bounds b;
    b.centre = to_vec3(cell->center());
    for (const unsigned int f : cell->face_indices()) {
      const auto face = cell->face(f);
      const Vec3 place = to_vec3(face->center()) - b.centre;
      const Vec3 normal = cross(to_vec3(face->vertex(3) - face->vertex(0)),
                                to_vec3(face->vertex(2) - face->vertex(1)));
      b.normal[f] = (dot(normal, place) < 0. ? -1. : 1.) / norm(normal) * normal;
      b.offset[f] = dot(b.normal[f], place);
    }
    const auto corners = cell->bounding_box().get_boundary_points();
    const Box box = {to_vec3(corners.first), to_vec3(corners.second)};
    for (unsigned int d = 0; d < 3; ++d) {
      around.lower[d] = std::min(around.lower[d], box.lower[d]);
      around.upper[d] = std::max(around.upper[d], box.upper[d]);
    }
    boxes.emplace_back(box, static_cast<std::int32_t>(cells.size()));
    cells.push_back(cell);
    bounds.push_back(b);
  }
  if (!cells.empty())
    tree = std::make_unique<const BoxTree>(boxes);
}

CellLocator::~CellLocator() = default;

bool CellLocator::Fit::is_better_than(const Fit &other) const
{
  const auto key = [](const Fit &fit) {
    return std::make_tuple(fit.outside, -fit.centre.x, -fit.centre.y, -fit.centre.z);
  };
  return key(*this) < key(other);
}

double CellLocator::outside(const Bounds &b, const Vec3 &x) const
{
  const Vec3 from = periods.shortest(x - b.centre);
  double most = -std::numeric_limits<double>::max();
  for (unsigned int f = 0; f < 6; ++f)
    most = std::max(most, dot(b.normal[f], from) - b.offset[f]);
  return most;
}

CellLocator::Fit CellLocator::find(const Vec3 &x, Cell &cell) const
{
  Fit best = {std::numeric_limits<double>::max(), {}};
  if (!tree)
    return best;
  const auto look = [&](const std::int32_t number) {
    const Bounds &b = bounds[static_cast<std::size_t>(number)];
    const Fit fit = {outside(b, x), b.centre};
    if (fit.is_better_than(best)) {
      best = fit;
      cell = cells[static_cast<std::size_t>(number)];
    }
  };
  constexpr unsigned int n_near = 16;
  tree->for_each_around(x, look);
  if (best.outside > 0.)
    tree->for_each_nearest(x, n_near, look);
  return best;
}

} // namespace eunoe
