// The background mesh before its refinement: from deal.II's generators or from a file.

#include <eunoe/core/deal_ii_message.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/domain/mesh.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

namespace eunoe {

namespace {

/// Number of cells of a mesh before its refinement as far as it can be known beforehand, else 1.
double count_coarse_cells(const MeshParameters &mesh)
{
  if (mesh.type == "lethe") {
    constexpr double most_of_a_layer = 16.;
    return most_of_a_layer * std::strtod(mesh.grid_arguments.c_str(), nullptr);
  }
  if (mesh.type == "gmsh" || mesh.grid_type.compare(0, 17, "subdivided_hyper_") != 0)
    return 1.;
  std::istringstream stream(mesh.grid_arguments.substr(0, mesh.grid_arguments.find(':')));
  double product = 1.;
  unsigned int n_numbers = 0;
  for (std::string word; std::getline(stream, word, ','); ++n_numbers)
    product *= std::strtod(word.c_str(), nullptr);
  return n_numbers == 1 ? std::pow(product, 3) : product;
}

/// Refuses what would fill the memory before anything else could be said of it.
void check_size(const MeshParameters &mesh, const double coarse, const unsigned int refinement)
{
  // Every rank holds the coarse cells, about a kilobyte each.
  constexpr double most_coarse = 1e7;
  const double cells = coarse * std::pow(8., refinement);
  if (coarse > most_coarse || cells > most_cells)
    throw UserError(describe(mesh.path, "") + ": the mesh would have " + format(cells) +
                    " cells, " + format(coarse) + " of them before the refinement. Give at most " +
                    format(most_cells) + " and " + format(most_coarse) +
                    ": the cells change no result.");
}

/// A manifold that is put where the mesh on it is.
class PlacedManifold : public dealii::Manifold<3>
{
public:
  PlacedManifold(std::unique_ptr<dealii::Manifold<3>> original, const Placement &placement)
      : original(std::move(original)), placement(placement)
  {
  }

  std::unique_ptr<dealii::Manifold<3>> clone() const override
  {
    return std::make_unique<PlacedManifold>(original->clone(), placement);
  }

  dealii::Point<3> get_new_point(const dealii::ArrayView<const dealii::Point<3>> &points,
                                 const dealii::ArrayView<const double> &weights) const override
  {
    std::vector<dealii::Point<3>> own;
    for (const dealii::Point<3> &x : points)
      own.push_back(to_point(placement.undo(to_vec3(x))));
    const dealii::Point<3> found =
        original->get_new_point(dealii::make_array_view(own.begin(), own.end()), weights);
    return to_point(placement(to_vec3(found)));
  }

private:
  const std::unique_ptr<dealii::Manifold<3>> original;
  const Placement placement;
};

void create_lethe_mesh(dealii::Triangulation<3> &triangulation, const MeshParameters &mesh)
{
  const std::set<std::string> kinds = {"cylinder_classic", "cylinder_balanced", "cylinder_squared",
                                       "cylinder_regularized"};
  if (kinds.count(mesh.grid_type) == 0)
    throw UserError(describe(mesh.path, "grid type") + ": '" + shortened(mesh.grid_type) +
                    "' is none of Lethe's own meshes that are known here. Give cylinder_classic, "
                    "cylinder_balanced, cylinder_squared or cylinder_regularized.");
  std::vector<double> numbers;
  try {
    numbers = dealii::Utilities::string_to_double(
        dealii::Utilities::split_string_list(mesh.grid_arguments, ':'));
  } catch (const std::exception &) {
    numbers.clear();
  }
  if (numbers.size() != 3 || !(numbers[0] >= 1.) || numbers[0] != std::floor(numbers[0]) ||
      !(numbers[1] > 0.) || !(numbers[2] > 0.))
    throw UserError(describe(mesh.path, "grid arguments") + ": is '" +
                    shortened(mesh.grid_arguments) +
                    "'. Give layers of cells along x : radius : half the length, all positive.");
  create_cylinder(triangulation, mesh.grid_type, static_cast<unsigned int>(numbers[0]), numbers[1],
                  numbers[2]);
}

void place(dealii::Triangulation<3> &triangulation, const Placement &placement)
{
  if (placement.is_identity())
    return;
  dealii::GridTools::transform(
      [&placement](const dealii::Point<3> &x) { return to_point(placement(to_vec3(x))); },
      triangulation);
  for (const dealii::types::manifold_id id : triangulation.get_manifold_ids()) {
    if (id == dealii::numbers::flat_manifold_id)
      continue;
    const dealii::Manifold<3> &manifold = triangulation.get_manifold(id);
    // These two follow the mesh.
    const bool follows =
        dynamic_cast<const dealii::FlatManifold<3> *>(&manifold) != nullptr ||
        dynamic_cast<const dealii::TransfiniteInterpolationManifold<3> *>(&manifold) != nullptr;
    if (!follows)
      triangulation.set_manifold(id, PlacedManifold(manifold.clone(), placement));
  }
}

} // namespace

double expected_cells(const MeshParameters &mesh)
{
  return count_coarse_cells(mesh) * std::pow(8., mesh.has_target ? 0 : mesh.refinement);
}

void check_mesh_size(const MeshParameters &mesh)
{
  check_size(mesh, count_coarse_cells(mesh), mesh.has_target ? 0 : mesh.refinement);
}

void create_mesh(dealii::Triangulation<3> &triangulation, const MeshParameters &mesh, MPI_Comm comm)
{
  check_mesh_size(mesh);
  try {
    if (mesh.type == "gmsh") {
      std::istringstream stream(read_background_mesh(mesh, comm));
      dealii::GridIn<3> reader;
      reader.attach_triangulation(triangulation);
      reader.read_msh(stream);
    } else if (mesh.type == "lethe")
      create_lethe_mesh(triangulation, mesh);
    else
      dealii::GridGenerator::generate_from_name_and_arguments(triangulation, mesh.grid_type,
                                                              mesh.grid_arguments);
  } catch (const UserError &) {
    throw;
  } catch (const std::exception &error) {
    throw UserError(describe(mesh.path, "") + ": the mesh cannot be made (" +
                    deal_ii_message(error) + "). Check " +
                    (mesh.type == "gmsh"
                         ? "that the hexahedra of " + shortened(mesh.file) + " fit together."
                         : "'grid type' and 'grid arguments' against deal.II's GridGenerator."));
  }
  place(triangulation, mesh.placement);
}

unsigned int global_refinement(const dealii::Triangulation<3> &triangulation,
                               const MeshParameters &mesh)
{
  if (!mesh.has_target)
    return mesh.refinement;
  const double ratio = dealii::GridTools::minimal_cell_diameter(triangulation) / mesh.target_size;
  const double times = std::max(0., std::floor(std::log2(ratio)));
  const auto refinement = static_cast<unsigned int>(std::min(times, 60.));
  check_size(mesh, static_cast<double>(triangulation.n_global_active_cells()), refinement);
  return refinement;
}

} // namespace eunoe
