#include <eunoe/domain/cell_locator.h>
#include <eunoe/domain/mesh.h>
#include <eunoe/solids/box_tree.h>

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace eunoe {

CellLocator::CellLocator(Domain &domain) : domain(domain) {}

CellLocator::~CellLocator() = default;

void CellLocator::rebuild()
{
  const auto &triangulation = domain.mesh().triangulation;
  std::map<unsigned int, std::vector<unsigned int>> groups;
  std::map<unsigned int, unsigned int> group_of;
  dealii::GridTools::collect_coinciding_vertices(triangulation, groups, group_of);
  representative.resize(triangulation.n_vertices());
  std::iota(representative.begin(), representative.end(), 0u);
  for (const auto &[vertex, group] : group_of)
    representative[vertex] = groups.at(group).front();

  cells.clear();
  bounds.assign(triangulation.n_active_cells(), Bounds());
  at_vertex.assign(triangulation.n_vertices(), {});
  std::vector<std::pair<Box, std::int32_t>> owned;
  for (const auto &cell : triangulation.active_cell_iterators()) {
    cells.push_back(cell);
    if (cell->is_artificial())
      continue;
    const unsigned int index = cell->active_cell_index();
    Bounds &b = bounds[index];
    b.centre = to_vec3(cell->center());
    const auto corners = cell->bounding_box().get_boundary_points();
    b.lower = to_vec3(corners.first) - b.centre;
    b.upper = to_vec3(corners.second) - b.centre;
    for (const unsigned int f : cell->face_indices()) {
      const auto face = cell->face(f);
      const Vec3 place = to_vec3(face->center()) - b.centre;
      const Vec3 normal = cross(to_vec3(face->vertex(3) - face->vertex(0)),
                                to_vec3(face->vertex(2) - face->vertex(1)));
      b.normal[f] = (dot(normal, place) < 0. ? -1. : 1.) / norm(normal) * normal;
      b.offset[f] = dot(b.normal[f], place);
    }
    for (const unsigned int v : cell->vertex_indices())
      at_vertex[representative[cell->vertex_index(v)]].push_back(index);
    if (cell->is_locally_owned())
      owned.emplace_back(Box{b.centre + b.lower, b.centre + b.upper},
                         static_cast<std::int32_t>(index));
  }
  tree = std::make_unique<const BoxTree>(owned);
}

double CellLocator::outside(const unsigned int cell, const Vec3 &x) const
{
  const Bounds &b = bounds[cell];
  const Vec3 from = domain.periods().shortest(x - b.centre);
  double most = -std::numeric_limits<double>::max();
  for (unsigned int f = 0; f < 6; ++f)
    most = std::max(most, dot(b.normal[f], from) - b.offset[f]);
  return most;
}

double CellLocator::gap(const unsigned int cell, const Vec3 &x) const
{
  const Bounds &b = bounds[cell];
  const Vec3 from = domain.periods().shortest(x - b.centre);
  double square = 0.;
  for (unsigned int d = 0; d < 3; ++d) {
    const double out = std::max({0., b.lower[d] - from[d], from[d] - b.upper[d]});
    square += out * out;
  }
  return std::sqrt(square);
}

unsigned int CellLocator::walk(unsigned int from, const Vec3 &x) const
{
  double least = outside(from, x);
  // What lies in a cell stays there; each turn of the loop comes closer.
  while (least > 0.) {
    unsigned int next = from;
    for (const unsigned int v : cells[from]->vertex_indices())
      for (const unsigned int near : at_vertex[representative[cells[from]->vertex_index(v)]]) {
        const double out = outside(near, x);
        if (out < least) {
          least = out;
          next = near;
        }
      }
    if (next == from)
      break;
    from = next;
  }
  return from;
}

unsigned int CellLocator::find(const Vec3 &x) const
{
  constexpr unsigned int n_near = 16;
  double least = std::numeric_limits<double>::max();
  unsigned int found = dealii::numbers::invalid_unsigned_int;
  const auto look = [&](const std::int32_t number) {
    const auto cell = static_cast<unsigned int>(number);
    const double out = outside(cell, x);
    if (out < least) {
      least = out;
      found = cell;
    }
  };
  tree->for_each_around(x, look);
  if (least > 0.)
    tree->for_each_nearest(x, n_near, look);
  return found;
}

} // namespace eunoe
