#include <eunoe/domain/mesh.h>
#include <eunoe/solids/enclosure.h>
#include <eunoe/solids/half_space.h>
#include <eunoe/solids/saved_states.h>
#include <eunoe/solids/surface_part.h>

#include <deal.II/grid/grid_tools.h>

#include "mesh_boundary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace eunoe {

namespace {

using Triangulation = dealii::parallel::distributed::Triangulation<3>;

/// Refines the cells that meet the box around a region's mesh by more than a face; collective.
void refine(Triangulation &triangulation, const RefinementParameters::Region &region)
{
  dealii::Triangulation<3> mesh;
  create_mesh(mesh, region.mesh, triangulation.get_communicator());
  const auto box = dealii::GridTools::compute_bounding_box(mesh).get_boundary_points();
  const double tolerance = 1e-9 * box.first.distance(box.second);
  for (unsigned int time = 0; time < region.additional; ++time) {
    for (const auto &cell : triangulation.active_cell_iterators()) {
      if (!cell->is_locally_owned())
        continue;
      const auto own = cell->bounding_box().get_boundary_points();
      bool meets = true;
      for (unsigned int d = 0; d < 3; ++d)
        meets = meets && own.second[d] > box.first[d] + tolerance &&
                own.first[d] < box.second[d] - tolerance;
      if (meets)
        cell->set_refine_flag();
    }
    triangulation.execute_coarsening_and_refinement();
    if (static_cast<double>(triangulation.n_global_active_cells()) > most_cells)
      throw UserError(describe(region.mesh.path, "") + ": the mesh has more than " +
                      format(most_cells) + " cells. Refine less: the cells change no result.");
  }
}

} // namespace

Domain::Domain(const Background &background, const BoundaryParameters &boundaries,
               const int wall_material, MPI_Comm comm)
    : comm(comm), mesh_data(std::make_unique<Mesh>(comm)), motion(background.motion)
{
  Triangulation &triangulation = mesh_data->triangulation;
  check_mesh_size(background.mesh);
  const auto sketch = !background.needs_cells && background.refinement.regions.empty()
                          ? sketch_of(background.mesh)
                          : std::nullopt;
  const MeshParameters &mesh = sketch ? *sketch : background.mesh;
  create_mesh(triangulation, mesh, comm);
  const auto bounding_box = dealii::GridTools::compute_bounding_box(triangulation);
  lower_corner = to_vec3(bounding_box.get_boundary_points().first);
  upper_corner = to_vec3(bounding_box.get_boundary_points().second);
  MeshBoundary boundary(triangulation);
  const std::set<unsigned int> periodic = join_periodic_ends(boundaries, boundary.sides());
  triangulation.refine_global(global_refinement(triangulation, mesh));
  for (const RefinementParameters::Region &region : background.refinement.regions)
    refine(triangulation, region);
  measure();
  boundary.refine(triangulation, periodic, box, moves());
  make_boundaries(boundaries, wall_material, boundary, periodic);
  if (!background.needs_cells)
    mesh_data.reset();
}

void Domain::move_to(const double time)
{
  if (motion)
    pose = motion->at(time);
}

nlohmann::ordered_json Domain::save() const
{
  return moves() ? to_json(earlier) : nlohmann::ordered_json();
}

void Domain::load(const nlohmann::ordered_json &saved)
{
  if (moves() && !saved.is_null())
    pose = earlier = state_in(saved);
}

Box Domain::box_from_centre() const
{
  if (!motion || !motion->rotates())
    return {lower_corner, upper_corner};
  // Whatever the axis, nothing is further from the centre than the furthest corner.
  Vec3 most;
  for (unsigned int d = 0; d < 3; ++d)
    most[d] = std::max(std::abs(lower_corner[d]), std::abs(upper_corner[d]));
  const double radius = norm(most);
  return {{-radius, -radius, -radius}, {radius, radius, radius}};
}

void Domain::measure()
{
  const double tolerance = 1e-10 * norm(upper_corner - lower_corner);
  bool boxes = true;
  Vec3 lower = lower_corner, upper = upper_corner;
  for (const auto &cell : mesh_data->triangulation.active_cell_iterators())
    if (cell->is_locally_owned()) {
      const auto cell_box = cell->bounding_box().get_boundary_points();
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int d = 0; d < 3; ++d) {
          const double x = cell->vertex(v)[d];
          lower[d] = std::min(lower[d], x);
          upper[d] = std::max(upper[d], x);
          const double end = (v >> d & 1) == 0 ? cell_box.first[d] : cell_box.second[d];
          boxes = boxes && std::abs(x - end) < tolerance;
        }
    }
  number_of_cells = mesh_data->triangulation.n_global_active_cells();
  mesh_data->has_boxes = dealii::Utilities::MPI::min(boxes ? 1 : 0, comm) == 1;
  // On a manifold the refined mesh reaches further than the coarse one.
  for (unsigned int d = 0; d < 3; ++d) {
    lower_corner[d] = dealii::Utilities::MPI::min(lower[d], comm);
    upper_corner[d] = dealii::Utilities::MPI::max(upper[d], comm);
  }
}

Domain::~Domain() = default;

const Domain::Mesh &Domain::mesh() const
{
  if (!mesh_data)
    throw std::logic_error("somebody asks for cells of the mesh without needs_cells()");
  return *mesh_data;
}

bool Domain::contains(const Vec3 &x) const
{
  if (enclosure)
    return enclosure->contains(to_own_frame(x));
  return std::all_of(sides.begin(), sides.end(),
                     [&](const auto &side) { return dot(x - side.first, side.second) >= 0.; });
}

int Domain::passed_outlet(const Vec3 &from, const Vec3 &x) const
{
  if (enclosure)
    return contains(x) ? -1 : enclosure->exit(in_frame(earlier, from), to_own_frame(x));
  for (std::size_t o = 0; o < outlet_list.size(); ++o)
    if (dot(x - outlet_list[o].point, outlet_list[o].inward) < 0.)
      return static_cast<int>(o);
  return -1;
}

namespace {

std::string place_of_condition(const std::size_t k)
{
  return "subsection 'DEM boundary conditions' / subsection 'boundary condition " +
         std::to_string(k) + "':";
}

/// Ids of the boundaries that are periodic. Throws a UserError if the mesh does not have one of
/// these; of the other conditions on boundaries that it does not have, @p problems is told as of
/// something doubtful.
std::set<unsigned int> find_periodic_ids(const BoundaryParameters &boundaries,
                                         const std::vector<Side> &all_sides, Problems &problems)
{
  std::set<unsigned int> periodic_ids;
  for (std::size_t k = 0; k < boundaries.conditions.size(); ++k) {
    const BoundaryCondition &c = boundaries.conditions[k];
    const bool periodic = c.type == "periodic";
    for (const unsigned int id :
         periodic ? std::vector<unsigned int>{c.periodic_ids[0], c.periodic_ids[1]}
                  : std::vector<unsigned int>{c.id})
    {
      if (periodic)
        periodic_ids.insert(id);
      if (std::any_of(all_sides.begin(), all_sides.end(),
                      [&](const Side &s) { return s.id == id; }))
        continue;
      const std::string what = "the mesh has no boundary " + std::to_string(id);
      const std::string mend = "Check the ids; for deal.II's generators they differ only with "
                               "'colorize' set to true in 'grid arguments'.";
      if (periodic)
        problems.add(place_of_condition(k), what + ".", mend);
      else
        problems.warn(place_of_condition(k), what + ", so the condition has no effect.", mend);
    }
  }
  if (!problems.empty())
    throw UserError(problems);
  return periodic_ids;
}

} // namespace

namespace {

/// Area of a flat boundary before refinement (m2).
double area_of(const Triangulation &triangulation, const unsigned int id)
{
  double area = 0.;
  for (const auto &cell : triangulation.cell_iterators_on_level(0))
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == id)
        area += 0.5 * norm(cross(to_vec3(cell->face(f)->vertex(3) - cell->face(f)->vertex(0)),
                                 to_vec3(cell->face(f)->vertex(2) - cell->face(f)->vertex(1))));
  return area;
}

} // namespace

std::set<unsigned int> Domain::join_periodic_ends(const BoundaryParameters &boundaries,
                                                  const std::vector<Side> &all_sides)
{
  Problems problems;
  const std::set<unsigned int> periodic_ids = find_periodic_ids(boundaries, all_sides, problems);
  if (!problems.empty())
    throw UserError(problems);
  list_of_doubts = problems.warnings();
  Triangulation &triangulation = mesh_data->triangulation;
  const double tolerance = 1e-9 * norm(upper_corner - lower_corner);
  for (std::size_t k = 0; k < boundaries.conditions.size(); ++k) {
    const BoundaryCondition &c = boundaries.conditions[k];
    if (c.type != "periodic")
      continue;
    const std::string where = place_of_condition(k);
    const unsigned int d = c.periodic_direction;
    const auto is_end = [&](unsigned int id, const Vec3 &corner) {
      return std::all_of(all_sides.begin(), all_sides.end(), [&](const Side &s) {
        return s.id != id || (std::abs(s.point[d] - corner[d]) < tolerance &&
                              std::abs(std::abs(s.inward[d]) - 1.) < 1e-9);
      });
    };
    unsigned int first = c.periodic_ids[0], second = c.periodic_ids[1];
    if (!is_end(first, lower_corner))
      std::swap(first, second);
    if (!is_end(first, lower_corner) || !is_end(second, upper_corner) || first == second) {
      problems.add(where,
                   "the boundaries " + std::to_string(first) + " and " + std::to_string(second) +
                       " are not the two flat ends of the domain in the periodic direction.",
                   "Choose two opposite boundaries and their axis.");
      continue;
    }
    if (const double one = area_of(triangulation, first), other = area_of(triangulation, second);
        std::abs(one - other) > 1e-6 * one)
      problems.add(where, "the two boundaries do not have the same shape.",
                   "Make the mesh the same at both ends.");
    box.length[d] = upper_corner[d] - lower_corner[d];
    box.origin[d] = lower_corner[d];
  }
  if (!problems.empty())
    throw UserError(problems);
  return periodic_ids;
}

namespace {

/// The wall of a boundary, without its shape.
/// @param is_plane for which a turning surface has the axis as its centre
Solid wall_of(const unsigned int id, const BoundaryCondition &c, const int material,
              const bool is_plane)
{
  Solid wall;
  wall.name = "boundary " + std::to_string(id);
  wall.boundary = id;
  wall.material = material;
  wall.output = false;
  const bool turns = c.type == "rotational";
  const Vec3 spin = turns ? c.rotational_speed / norm(c.rotation_axis) * c.rotation_axis : Vec3();
  const Vec3 speed = c.type == "translational" ? c.speed : Vec3();
  if (turns && is_plane)
    wall.motion = std::make_shared<AtRest>(c.rotation_point, speed, spin);
  else
    wall.motion = std::make_shared<AtRest>(Vec3(), speed + cross(c.rotation_point, spin), spin);
  return wall;
}

} // namespace

void Domain::make_boundaries(const BoundaryParameters &boundaries, const int wall_material,
                             const MeshBoundary &boundary, const std::set<unsigned int> &periodic)
{
  const std::vector<Side> &all_sides = boundary.sides();
  const BoundaryCondition fixed;
  const auto condition = [&](unsigned int id) -> const BoundaryCondition & {
    for (const BoundaryCondition &c : boundaries.conditions)
      if (c.type != "periodic" && c.id == id)
        return c;
    return fixed;
  };
  std::map<unsigned int, int> outlet_of, part_of;
  for (std::size_t s = 0; s < all_sides.size(); ++s) {
    const Side &side = all_sides[s];
    if (periodic.count(side.id) != 0)
      continue;
    const BoundaryCondition &c = condition(side.id);
    const int material = c.material < 0 ? wall_material : c.material;
    if (boundary.is_convex())
      sides.emplace_back(side.point, side.inward);
    if (c.type == "outlet") {
      if (boundary.is_convex() || outlet_of.count(side.id) == 0) {
        outlet_of[side.id] = static_cast<int>(outlet_list.size());
        outlet_list.push_back({side.id, side.point, side.inward});
      }
    } else if (boundary.is_convex() || boundary.is_plane(s)) {
      Solid wall = wall_of(side.id, c, material, true);
      wall.shape =
          std::make_shared<HalfSpace>(side.point - wall.motion->at(0.).centre, side.inward);
      wall_solids.push_back(wall);
    } else if (part_of.count(side.id) == 0) {
      part_of[side.id] = static_cast<int>(wall_solids.size());
      wall_solids.push_back(wall_of(side.id, c, material, false));
      if (motion)
        wall_solids.back().motion = motion;
    }
  }
  if (!boundary.is_convex())
    make_surfaces(boundary, outlet_of, part_of);
}

void Domain::make_surfaces(const MeshBoundary &boundary, const std::map<unsigned int, int> &outlets,
                           const std::map<unsigned int, int> &walls)
{
  std::vector<Enclosure::Triangle> all;
  TriangleMesh mesh;
  const auto wall_of_triangle = std::make_shared<std::vector<int>>();
  // What coincides but for round-off is united later, for which there should be few vertices.
  std::map<std::array<double, 3>, std::int32_t> vertex_at;
  const auto vertex = [&](const Vec3 &x) {
    const auto [place, is_new] =
        vertex_at.emplace(std::array<double, 3>{{x.x, x.y, x.z}}, mesh.vertices.size());
    if (is_new)
      mesh.vertices.push_back(x);
    return place->second;
  };
  for (const BoundaryFace &face : boundary.faces()) {
    const unsigned int id = boundary.sides()[face.side].id;
    const auto outlet = outlets.find(id);
    for (const std::array<Vec3, 3> &triangle : triangles_of(face))
      with_images(triangle, box, [&](const std::array<Vec3, 3> &image) {
        all.push_back({image, outlet == outlets.end() ? -1 : outlet->second});
        if (outlet != outlets.end() || face.is_flat)
          return;
        mesh.triangles.push_back({{vertex(image[0]), vertex(image[1]), vertex(image[2])}});
        wall_of_triangle->push_back(walls.at(id));
      });
  }
  enclosure = std::make_unique<Enclosure>(std::move(all), box);
  if (walls.empty())
    return;
  const std::string defect = mesh.defect();
  if (!defect.empty())
    throw UserError("subsection 'mesh': the boundary cannot be a wall: " + defect +
                    ". Check the cells of the mesh at the boundary.");
  const auto surface = std::make_shared<const TriangulatedSurface>(std::move(mesh));
  for (const auto &[id, wall] : walls)
    if (walls.size() == 1)
      wall_solids[wall].shape = surface;
    else
      wall_solids[wall].shape = std::make_shared<SurfacePart>(surface, wall, wall_of_triangle);
}

} // namespace eunoe
