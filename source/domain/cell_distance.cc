// How far apart cells are that do not touch, in meshes of any cells.

#include <eunoe/domain/mesh.h>

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace eunoe {

namespace {

using Cell = dealii::Triangulation<3>::active_cell_iterator;

/// The corners of a face as a set of numbers, and its plane by a point and a normal of length 1.
struct Face
{
  std::array<unsigned int, 4> vertex;
  std::array<Vec3, 4> corner;
  Vec3 point, outward;
};

/// A cell as what its faces bound, moved by a multiple of the periods.
struct Body
{
  std::array<Vec3, 8> corner;
  std::array<Face, 6> face;

  Body(const Cell &cell, const std::vector<unsigned int> &representative, const Vec3 &shift)
  {
    const Vec3 centre = to_vec3(cell->center()) + shift;
    for (const unsigned int v : cell->vertex_indices())
      corner[v] = to_vec3(cell->vertex(v)) + shift;
    for (const unsigned int f : cell->face_indices()) {
      const auto side = cell->face(f);
      Face &own = face[f];
      for (unsigned int v = 0; v < 4; ++v) {
        own.vertex[v] = representative[side->vertex_index(v)];
        own.corner[v] = to_vec3(side->vertex(v)) + shift;
        own.point += 0.25 * own.corner[v];
      }
      own.outward = cross(own.corner[3] - own.corner[0], own.corner[2] - own.corner[1]);
      own.outward =
          (dot(own.outward, own.point - centre) < 0. ? -1. : 1.) / norm(own.outward) * own.outward;
    }
  }
};

/// A distance that a body and a face keep at least, by the planes of their faces. Exact for boxes.
double separation_by_planes(const Body &body, const Face &face)
{
  double most = 0.;
  for (const Face &own : body.face) {
    double least = std::numeric_limits<double>::max();
    for (const Vec3 &x : face.corner)
      least = std::min(least, dot(x - own.point, own.outward));
    most = std::max(most, least);
  }
  double behind = std::numeric_limits<double>::max();
  for (const Vec3 &x : body.corner)
    behind = std::min(behind, -dot(x - face.point, face.outward));
  return std::max(most, behind);
}

/// A distance (m) that the convex hulls of a body and a face keep at least, within a hundredth of
/// what they do keep, unless they are closer than @p close or touch.
///
/// The point of least norm among the differences of their points: Gilbert's algorithm (SIAM J.
/// Control 4, 1966), which has such a bound at every step.
double separation(const Body &body, const Face &face, const double close)
{
  constexpr unsigned int most_steps = 300;
  double bound = separation_by_planes(body, face);
  Vec3 least = body.corner[0] - face.corner[0];
  for (unsigned int step = 0; step < most_steps && bound < close; ++step) {
    const auto along = [&](const Vec3 &a, const Vec3 &b) { return dot(a, least) < dot(b, least); };
    const Vec3 support = *std::min_element(body.corner.begin(), body.corner.end(), along) -
                         *std::max_element(face.corner.begin(), face.corner.end(), along);
    const double length = norm(least);
    if (!(length > 0.))
      break;
    bound = std::max(bound, dot(support, least) / length);
    if (bound > 0.99 * length)
      break;
    const Vec3 step_to = support - least;
    const double share = -dot(least, step_to) / norm_square(step_to);
    least += std::min(1., share) * step_to;
  }
  return bound;
}

/// Whether there are other cells than those of a set on the far side of a face.
bool leads_out(const Cell &cell, const unsigned int f, const std::map<unsigned int, Cell> &set)
{
  const bool is_periodic = cell->has_periodic_neighbor(f);
  if (cell->at_boundary(f) && !is_periodic)
    return false;
  const auto neighbour = is_periodic ? cell->periodic_neighbor(f) : cell->neighbor(f);
  if (neighbour->is_active())
    return set.count(neighbour->active_cell_index()) == 0;
  for (unsigned int k = 0; k < 4; ++k) {
    const auto child = is_periodic ? cell->periodic_neighbor_child_on_subface(f, k)
                                   : cell->neighbor_child_on_subface(f, k);
    if (!child->is_active() || set.count(child->active_cell_index()) == 0)
      return true;
  }
  return false;
}

} // namespace

double smallest_distance_of_cells_apart(const Domain::Mesh &mesh, const PeriodicBox &periods)
{
  const auto &triangulation = mesh.triangulation;
  std::map<unsigned int, std::vector<unsigned int>> groups;
  std::map<unsigned int, unsigned int> group_of;
  dealii::GridTools::collect_coinciding_vertices(triangulation, groups, group_of);
  std::vector<unsigned int> representative(triangulation.n_vertices());
  for (unsigned int v = 0; v < representative.size(); ++v) {
    const auto group = group_of.find(v);
    representative[v] = group == group_of.end() ? v : groups.at(group->second).front();
  }
  std::vector<std::vector<Cell>> at_vertex(triangulation.n_vertices());
  for (const auto &cell : triangulation.active_cell_iterators())
    if (!cell->is_artificial())
      for (const unsigned int v : cell->vertex_indices())
        at_vertex[representative[cell->vertex_index(v)]].push_back(cell);

  double smallest = std::numeric_limits<double>::max();
  for (const auto &cell : triangulation.active_cell_iterators()) {
    if (!cell->is_locally_owned())
      continue;
    const Body body(cell, representative, Vec3());
    std::set<unsigned int> vertices;
    std::map<unsigned int, Cell> around;
    for (const unsigned int v : cell->vertex_indices()) {
      vertices.insert(representative[cell->vertex_index(v)]);
      for (const Cell &near : at_vertex[representative[cell->vertex_index(v)]])
        around.emplace(near->active_cell_index(), near);
    }
    for (const auto &[index, near] : around) {
      if (near == cell)
        continue;
      const Vec3 away = to_vec3(near->center() - cell->center());
      const Body other(near, representative, periods.shortest(away) - away);
      for (const unsigned int f : near->face_indices()) {
        const Face &face = other.face[f];
        const bool touches = std::any_of(face.vertex.begin(), face.vertex.end(),
                                         [&](unsigned int v) { return vertices.count(v) != 0; });
        if (!touches && leads_out(near, f, around))
          smallest = std::min(smallest, separation(body, face, smallest));
      }
    }
  }
  return smallest;
}

} // namespace eunoe
