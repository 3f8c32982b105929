#include <eunoe/solids/half_space.h>

#include <deal.II/fe/mapping_cartesian.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>

#include "mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

namespace eunoe {

namespace {

using Triangulation = dealii::parallel::distributed::Triangulation<3>;

/// What went wrong inside deal.II, without its stack trace.
std::string first_line_of_message(const std::exception &error)
{
  const auto *const exception = dynamic_cast<const dealii::ExceptionBase *>(&error);
  if (exception == nullptr)
    return error.what();
  std::ostringstream text;
  exception->print_info(text);
  std::string line = text.str();
  std::replace(line.begin(), line.end(), '\n', ' ');
  const std::size_t begin = line.find_first_not_of(' ');
  return begin == std::string::npos ? "unknown reason" : line.substr(begin);
}

/// Number of cells of a mesh before its refinement as far as it can be known beforehand, else 1.
double count_coarse_cells(const MeshParameters &mesh)
{
  if (mesh.type == "gmsh" || mesh.grid_type.compare(0, 11, "subdivided_") != 0)
    return 1.;
  std::istringstream stream(mesh.grid_arguments.substr(0, mesh.grid_arguments.find(':')));
  double product = 1.;
  unsigned int n_numbers = 0;
  for (std::string word; std::getline(stream, word, ','); ++n_numbers)
    product *= std::strtod(word.c_str(), nullptr);
  return n_numbers == 1 ? std::pow(product, 3) : product;
}

/// Refuses what would fill the memory before anything else could be said of it.
void check_size(const MeshParameters &mesh)
{
  // Every rank holds the coarse cells, about a kilobyte each.
  constexpr double most_coarse = 1e7, most = 1e9;
  const double coarse = count_coarse_cells(mesh);
  const double cells = coarse * std::pow(8., mesh.refinement);
  if (coarse > most_coarse || cells > most)
    throw UserError("subsection 'mesh': the mesh would have " + format(cells) + " cells, " +
                    format(coarse) + " of them before the refinement. Give at most " +
                    format(most) + " and " + format(most_coarse) +
                    "; 8 to 10 particles a cell are best.");
}

void create(Triangulation &triangulation, const MeshParameters &mesh)
{
  check_size(mesh);
  try {
    if (mesh.type == "gmsh") {
      std::ifstream stream(mesh.file);
      if (!stream)
        throw UserError("subsection 'mesh' / entry 'file name': " + mesh.file +
                        " cannot be read. Check the name and the permissions.");
      dealii::GridIn<3> reader;
      reader.attach_triangulation(triangulation);
      reader.read_msh(stream);
    } else
      dealii::GridGenerator::generate_from_name_and_arguments(triangulation, mesh.grid_type,
                                                              mesh.grid_arguments);
  } catch (const UserError &) {
    throw;
  } catch (const std::exception &error) {
    throw UserError("subsection 'mesh': the mesh cannot be made (" + first_line_of_message(error) +
                    "). Check " +
                    (mesh.type == "gmsh"
                         ? "that " + mesh.file + " is a Gmsh file of hexahedra."
                         : "'grid type' and 'grid arguments' against deal.II's GridGenerator."));
  }
  if (!mesh.placement.is_identity())
    dealii::GridTools::transform(
        [&mesh](const dealii::Point<3> &x) { return to_point(mesh.placement(to_vec3(x))); },
        triangulation);
}

/// A flat part of the boundary with one id.
struct Side
{
  unsigned int id;
  Vec3 point, inward;
};

/// All flat parts of the boundary of the coarse mesh.
std::vector<Side> find_sides(const Triangulation &triangulation, double tolerance)
{
  std::vector<Side> sides;
  for (const auto &cell : triangulation.cell_iterators_on_level(0))
    for (const auto &face : cell->face_iterators()) {
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
      if (std::none_of(sides.begin(), sides.end(), same))
        sides.push_back({face->boundary_id(), point, normal});
    }
  return sides;
}

} // namespace

Domain::Domain(const MeshParameters &parameters, const BoundaryParameters &boundaries,
               const int wall_material, MPI_Comm comm)
    : comm(comm), mesh_data(std::make_unique<Mesh>(comm))
{
  Triangulation &triangulation = mesh_data->triangulation;
  create(triangulation, parameters);

  const auto bounding_box = dealii::GridTools::compute_bounding_box(triangulation);
  lower_corner = to_vec3(bounding_box.get_boundary_points().first);
  upper_corner = to_vec3(bounding_box.get_boundary_points().second);
  find_boundaries(boundaries, wall_material);
  triangulation.refine_global(parameters.refinement);

  const double tolerance = 1e-10 * norm(upper_corner - lower_corner);
  bool boxes = true;
  cell_width = std::numeric_limits<double>::max();
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned()) {
      for (unsigned int d = 0; d < 3; ++d)
        cell_width = std::min(cell_width, cell->extent_in_direction(d));
      const auto cell_box = cell->bounding_box().get_boundary_points();
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int d = 0; d < 3; ++d)
          boxes = boxes && (std::abs(cell->vertex(v)[d] - cell_box.first[d]) < tolerance ||
                            std::abs(cell->vertex(v)[d] - cell_box.second[d]) < tolerance);
    }
  cell_width = dealii::Utilities::MPI::min(cell_width, comm);
  mesh_data->has_boxes = dealii::Utilities::MPI::min(boxes ? 1 : 0, comm) == 1;
  if (mesh_data->has_boxes)
    mesh_data->mapping = std::make_unique<dealii::MappingCartesian<3>>();
  else
    mesh_data->mapping = std::make_unique<dealii::MappingQ1<3>>();
}

Domain::~Domain() = default;

bool Domain::contains(const Vec3 &x) const
{
  return std::all_of(sides.begin(), sides.end(),
                     [&](const auto &side) { return dot(x - side.first, side.second) >= 0.; });
}

std::uint64_t Domain::n_cells() const
{
  return mesh_data->triangulation.n_global_active_cells();
}

void Domain::find_boundaries(const BoundaryParameters &boundaries, const int wall_material)
{
  Triangulation &triangulation = mesh_data->triangulation;
  const double tolerance = 1e-9 * norm(upper_corner - lower_corner);
  const std::vector<Side> all_sides = find_sides(triangulation, tolerance);
  const std::string section = "subsection 'DEM boundary conditions' / ";
  Problems problems;

  std::map<unsigned int, const BoundaryCondition *> condition_of;
  std::map<unsigned int, unsigned int> condition_number;
  for (std::size_t k = 0; k < boundaries.conditions.size(); ++k) {
    const BoundaryCondition &c = boundaries.conditions[k];
    const bool periodic = c.type == "periodic";
    for (const unsigned int id :
         periodic ? std::vector<unsigned int>{c.periodic_ids[0], c.periodic_ids[1]}
                  : std::vector<unsigned int>{c.id})
    {
      condition_of[id] = &c;
      condition_number[id] = static_cast<unsigned int>(k);
      if (std::none_of(all_sides.begin(), all_sides.end(),
                       [&](const Side &s) { return s.id == id; }))
        problems.add(section + "subsection 'boundary condition " + std::to_string(k) + "':",
                     "the mesh has no boundary " + std::to_string(id) + ".",
                     "Check the ids; for deal.II's generators they differ only with 'colorize' set "
                     "to true in 'grid arguments'.");
    }
  }
  if (!problems.empty())
    throw UserError(problems);

  std::vector<dealii::GridTools::PeriodicFacePair<Triangulation::cell_iterator>> pairs;
  for (std::size_t k = 0; k < boundaries.conditions.size(); ++k) {
    const BoundaryCondition &c = boundaries.conditions[k];
    if (c.type != "periodic")
      continue;
    const std::string where =
        section + "subsection 'boundary condition " + std::to_string(k) + "':";
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
    try {
      dealii::GridTools::collect_periodic_faces(triangulation, first, second, d, pairs);
    } catch (const std::exception &) {
      problems.add(where, "the faces of the two boundaries do not match.",
                   "Make the mesh the same on both.");
    }
    box.length[d] = upper_corner[d] - lower_corner[d];
    box.origin[d] = lower_corner[d];
  }
  if (!problems.empty())
    throw UserError(problems);
  triangulation.add_periodicity(pairs);

  for (const Side &side : all_sides) {
    const auto it = condition_of.find(side.id);
    const BoundaryCondition fixed;
    const BoundaryCondition &c = it == condition_of.end() ? fixed : *it->second;
    if (c.type == "periodic")
      continue;
    for (const auto &cell : triangulation.cell_iterators_on_level(0))
      for (const unsigned int v : cell->vertex_indices())
        if (dot(to_vec3(cell->vertex(v)) - side.point, side.inward) < -tolerance)
          throw UserError("subsection 'mesh': boundary " + std::to_string(side.id) +
                          " is curved or bends inwards. Background meshes must be convex with flat "
                          "sides; give other shapes as 'solid objects'.");
    sides.emplace_back(side.point, side.inward);
    if (c.type == "outlet") {
      outlet_list.push_back({side.id, side.point, side.inward});
      continue;
    }
    Solid wall;
    wall.name = "boundary " + std::to_string(side.id);
    wall.material = c.material < 0 ? wall_material : c.material;
    wall.output = false;
    const bool turns = c.type == "rotational";
    const Vec3 centre = turns ? c.rotation_point : Vec3();
    wall.shape = std::make_shared<HalfSpace>(side.point - centre, side.inward);
    wall.motion = std::make_shared<AtRest>(
        centre, c.type == "translational" ? c.speed : Vec3(),
        turns ? c.rotational_speed / norm(c.rotation_axis) * c.rotation_axis : Vec3());
    wall_solids.push_back(wall);
  }
}

} // namespace eunoe
