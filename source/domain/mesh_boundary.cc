#include "mesh_boundary.h"

#include <eunoe/domain/mesh.h>
#include <eunoe/solids/triangulated_surface.h>

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace eunoe {

namespace {

/// Edges that turn by less count as smooth, as in TriangulatedSurface.
const double smooth_cosine = std::cos(TriangulatedSurface::smooth_angle) - 1e-9;

using Cell = MeshBoundary::Triangulation::active_cell_iterator;

/// The corners of a face of a cell in a turn. Where the next cell at an edge is finer, its corner
/// on the edge counts, too, so that the faces leave no gap.
std::vector<Vec3> corners_of(const Cell &cell, const unsigned int f)
{
  const auto face = cell->face(f);
  std::vector<Vec3> corners;
  constexpr std::array<unsigned int, 4> turn = {{0, 1, 3, 2}};
  for (unsigned int k = 0; k < 4; ++k) {
    const unsigned int from = face->vertex_index(turn[k]),
                       to = face->vertex_index(turn[(k + 1) % 4]);
    corners.push_back(to_vec3(face->vertex(turn[k])));
    for (unsigned int l = 0; l < 4; ++l) {
      const auto line = face->line(l);
      const bool is_this = (line->vertex_index(0) == from && line->vertex_index(1) == to) ||
                           (line->vertex_index(0) == to && line->vertex_index(1) == from);
      if (is_this && line->has_children())
        corners.push_back(to_vec3(line->child(0)->vertex(1)));
    }
  }
  return corners;
}

/// The unit normal of a polygon, by the mean of its triangles (Newell), to the side of a point.
Vec3 normal_towards(const std::vector<Vec3> &corners, const Vec3 &inside)
{
  Vec3 sum;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    sum += cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
  sum = sum / norm(sum);
  return dot(sum, inside - corners[0]) < 0. ? -sum : sum;
}

/// A face on its way to other ranks.
struct Parcel
{
  std::array<unsigned int, 5> key; ///< of cell and face, the same on any number of ranks
  int side;
  std::vector<double> coordinates; ///< of a point inside, then of the corners

  template <class Archive>
  void serialize(Archive &archive, const unsigned int)
  {
    archive &key &side &coordinates;
  }
};

} // namespace

MeshBoundary::MeshBoundary(const Triangulation &triangulation)
{
  const auto box = dealii::GridTools::compute_bounding_box(triangulation).get_boundary_points();
  tolerance = 1e-9 * box.first.distance(box.second);
  find_sides(triangulation);
}

void MeshBoundary::find_sides(const Triangulation &triangulation)
{
  // Sides by their distance from a place. The place must not have the same distance from many
  // sides, as the middle of a cylinder has.
  const auto box = dealii::GridTools::compute_bounding_box(triangulation);
  const Vec3 lower = to_vec3(box.get_boundary_points().first),
             extent = to_vec3(box.get_boundary_points().second) - lower;
  const Vec3 place = lower + Vec3{0.3141 * extent.x, 0.2718 * extent.y, 0.5772 * extent.z};
  std::multimap<double, std::size_t> by_distance;

  side_of_face.assign(triangulation.n_cells(0), {{-1, -1, -1, -1, -1, -1}});
  for (const auto &cell : triangulation.cell_iterators_on_level(0))
    for (const unsigned int f : cell->face_indices()) {
      const auto face = cell->face(f);
      if (!face->at_boundary())
        continue;
      const Vec3 point = to_vec3(face->vertex(0));
      Vec3 normal = cross(to_vec3(face->vertex(1)) - point, to_vec3(face->vertex(2)) - point);
      normal = normal / norm(normal);
      if (dot(normal, to_vec3(cell->center()) - point) < 0.)
        normal = -normal;
      const auto same = [&](const Side &side) {
        return side.id == face->boundary_id() && dot(side.inward, normal) > 0.5 &&
               std::all_of(face->vertex_indices().begin(), face->vertex_indices().end(),
                           [&](unsigned int v) {
                             return std::abs(dot(to_vec3(face->vertex(v)) - side.point,
                                                 side.inward)) < tolerance;
                           });
      };
      const double distance = dot(point - place, normal), range = 1e4 * tolerance;
      std::size_t number = all_sides.size();
      for (auto it = by_distance.lower_bound(distance - range);
           it != by_distance.end() && it->first <= distance + range; ++it)
        if (same(all_sides[it->second]))
          number = std::min(number, it->second);
      if (number == all_sides.size()) {
        all_sides.push_back({face->boundary_id(), point, normal});
        by_distance.emplace(distance, number);
      }
      side_of_face[cell->index()][f] = static_cast<int>(number);
    }
  order_sides();
}

void MeshBoundary::order_sides()
{
  std::vector<std::size_t> order(all_sides.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [this](const std::size_t a, const std::size_t b) {
    return all_sides[a].id < all_sides[b].id;
  });
  std::vector<int> place(order.size());
  std::vector<Side> ordered;
  for (const std::size_t side : order) {
    place[side] = static_cast<int>(ordered.size());
    ordered.push_back(all_sides[side]);
  }
  all_sides = ordered;
  for (std::array<int, 6> &sides : side_of_face)
    for (int &side : sides)
      if (side >= 0)
        side = place[static_cast<std::size_t>(side)];
}

bool MeshBoundary::is_alone(const std::size_t side) const
{
  const Side &s = all_sides[side];
  return std::none_of(all_sides.begin(), all_sides.end(), [&](const Side &other) {
    return &other != &s && periodic_ids.count(other.id) == 0 && dot(other.inward, s.inward) > 0.5 &&
           1. - dot(other.inward, s.inward) < 1e-12 &&
           std::abs(dot(other.point - s.point, s.inward)) < tolerance;
  });
}

bool MeshBoundary::is_convex_before_refinement(const Triangulation &triangulation) const
{
  std::map<unsigned int, std::size_t> side_at_line;
  for (const auto &cell : triangulation.cell_iterators_on_level(0))
    for (const unsigned int f : cell->face_indices()) {
      const int side = side_of_face[cell->index()][f];
      if (side < 0 || periodic_ids.count(all_sides[side].id) != 0)
        continue;
      for (unsigned int l = 0; l < 4; ++l) {
        const std::size_t other =
            side_at_line.emplace(cell->face(f)->line_index(l), side).first->second;
        if (other != static_cast<std::size_t>(side) &&
            dot(all_sides[other].inward, all_sides[side].inward) >= smooth_cosine)
          return false;
      }
    }
  for (std::size_t s = 0; s < all_sides.size(); ++s) {
    const Side &side = all_sides[s];
    if (periodic_ids.count(side.id) != 0)
      continue;
    if (!is_alone(s))
      return false;
    for (const auto &cell : triangulation.cell_iterators_on_level(0))
      for (const unsigned int v : cell->vertex_indices())
        if (dot(to_vec3(cell->vertex(v)) - side.point, side.inward) < -tolerance)
          return false;
  }
  return true;
}

namespace {

/// Calls @p look for the faces of this rank's cells in the boundary that descend from a side.
template <typename Look>
void visit_faces(const MeshBoundary::Triangulation &triangulation,
                 const std::vector<std::array<int, 6>> &side_of_face, const Look &look)
{
  for (const auto &cell : triangulation.active_cell_iterators()) {
    if (!cell->is_locally_owned() || !cell->at_boundary())
      continue;
    dealii::Triangulation<3>::cell_iterator coarse = cell;
    while (coarse->level() > 0)
      coarse = coarse->parent();
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary())
        look(cell, f, side_of_face[coarse->index()][f]);
  }
}

} // namespace

bool MeshBoundary::has_strayed(const Triangulation &triangulation) const
{
  int strayed = 0;
  visit_faces(triangulation, side_of_face, [&](const Cell &cell, unsigned int f, int number) {
    const Side &side = all_sides[number];
    if (periodic_ids.count(side.id) != 0)
      return;
    for (const unsigned int v : cell->face(f)->vertex_indices())
      if (std::abs(dot(to_vec3(cell->face(f)->vertex(v)) - side.point, side.inward)) > tolerance)
        strayed = 1;
  });
  return dealii::Utilities::MPI::max(strayed, triangulation.get_communicator()) != 0;
}

void MeshBoundary::refine(const Triangulation &triangulation,
                          const std::set<unsigned int> &periodic, const PeriodicBox &periods,
                          const bool moves)
{
  periodic_ids = periodic;
  convex = !moves && !has_strayed(triangulation) && is_convex_before_refinement(triangulation);
  if (convex)
    return;
  gather(triangulation);
  if (moves)
    planes.assign(all_sides.size(), false);
  else
    find_planes(periods);
}

void MeshBoundary::gather(const Triangulation &triangulation)
{
  std::vector<Parcel> mine, all;
  visit_faces(triangulation, side_of_face, [&](const Cell &cell, unsigned int f, int side) {
    if (periodic_ids.count(all_sides[side].id) != 0)
      return;
    Parcel parcel;
    const auto id = cell->id().to_binary<3>();
    std::copy(id.begin(), id.end(), parcel.key.begin());
    parcel.key[4] = f;
    parcel.side = side;
    std::vector<Vec3> points = corners_of(cell, f);
    points.insert(points.begin(), to_vec3(cell->center()));
    for (const Vec3 &x : points)
      parcel.coordinates.insert(parcel.coordinates.end(), {x.x, x.y, x.z});
    mine.push_back(parcel);
  });
  for (const auto &part :
       dealii::Utilities::MPI::all_gather(triangulation.get_communicator(), mine))
    all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end(), [](const Parcel &a, const Parcel &b) { return a.key < b.key; });
  for (const Parcel &parcel : all) {
    BoundaryFace face;
    face.side = parcel.side;
    for (std::size_t k = 3; k < parcel.coordinates.size(); k += 3)
      face.corners.push_back(
          {parcel.coordinates[k], parcel.coordinates[k + 1], parcel.coordinates[k + 2]});
    face.inward = normal_towards(
        face.corners, {parcel.coordinates[0], parcel.coordinates[1], parcel.coordinates[2]});
    all_faces.push_back(face);
  }
}

void MeshBoundary::find_planes(const PeriodicBox &periods)
{
  planes.assign(all_sides.size(), true);
  const auto is_on = [&](const Side &side, const Vec3 &x) {
    return std::abs(dot(x - side.point, side.inward)) <= tolerance;
  };
  // Corners of one place have the same bits, as they are one vertex of the mesh.
  using Point = std::array<double, 3>;
  std::map<std::pair<Point, Point>, std::size_t> face_at_edge;
  std::set<Point> vertices;
  for (std::size_t k = 0; k < all_faces.size(); ++k) {
    const BoundaryFace &face = all_faces[k];
    const std::size_t n = face.corners.size();
    for (std::size_t c = 0; c < n; ++c) {
      const Vec3 &x = face.corners[c], &y = face.corners[(c + 1) % n];
      const Point a = {{x.x, x.y, x.z}}, b = {{y.x, y.y, y.z}};
      vertices.insert(a);
      planes[face.side] = planes[face.side] && is_on(all_sides[face.side], x);
      const BoundaryFace &other =
          all_faces[face_at_edge.emplace(std::minmax(a, b), k).first->second];
      if (other.side != face.side && dot(other.inward, face.inward) >= smooth_cosine)
        planes[face.side] = planes[other.side] = false;
    }
  }
  for (std::size_t s = 0; s < all_sides.size(); ++s) {
    const Side &side = all_sides[s];
    bool ok = planes[s] && periodic_ids.count(side.id) == 0 && is_alone(s);
    for (unsigned int d = 0; d < 3; ++d)
      ok = ok && !(periods.is_periodic(d) && std::abs(side.inward[d]) > 1e-9);
    planes[s] = ok && std::all_of(vertices.begin(), vertices.end(), [&](const Point &x) {
                  return dot(Vec3{x[0], x[1], x[2]} - side.point, side.inward) >= -tolerance;
                });
  }
  for (BoundaryFace &face : all_faces)
    face.is_flat = planes[face.side];
}

std::vector<std::array<Vec3, 3>> triangles_of(const BoundaryFace &face)
{
  const std::vector<Vec3> &c = face.corners;
  if (c.size() == 4) {
    const Vec3 across = (c[0] + c[2]) - (c[1] + c[3]);
    // Of a flat face, either diagonal will do; round-off does not choose.
    if (dot(across, face.inward) > -1e-9 * norm(c[2] - c[0]))
      return {{{c[0], c[1], c[2]}}, {{c[0], c[2], c[3]}}};
    return {{{c[1], c[2], c[3]}}, {{c[1], c[3], c[0]}}};
  }
  Vec3 middle;
  for (const Vec3 &x : c)
    middle += x / static_cast<double>(c.size());
  std::vector<std::array<Vec3, 3>> triangles;
  for (std::size_t k = 0; k < c.size(); ++k)
    triangles.push_back({{middle, c[k], c[(k + 1) % c.size()]}});
  return triangles;
}

} // namespace eunoe
