// The background mesh before its refinement: from deal.II's generators or from a file.

#include <eunoe/core/problems.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include "mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace eunoe {

namespace {

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
void check_size(const MeshParameters &mesh)
{
  // Every rank holds the coarse cells, about a kilobyte each.
  constexpr double most_coarse = 1e7;
  const double coarse = count_coarse_cells(mesh);
  const double cells = coarse * std::pow(8., mesh.refinement);
  if (coarse > most_coarse || cells > most_cells)
    throw UserError(describe(mesh.path, "") + ": the mesh would have " + format(cells) +
                    " cells, " + format(coarse) + " of them before the refinement. Give at most " +
                    format(most_cells) + " and " + format(most_coarse) +
                    "; 8 to 10 particles a cell are best.");
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

void create_mesh(dealii::Triangulation<3> &triangulation, const MeshParameters &mesh)
{
  check_size(mesh);
  try {
    if (mesh.type == "gmsh") {
      std::ifstream stream(mesh.file);
      if (!stream)
        throw UserError(describe(mesh.path, "file name") + ": " + mesh.file +
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
    throw UserError(describe(mesh.path, "") + ": the mesh cannot be made (" +
                    first_line_of_message(error) + "). Check " +
                    (mesh.type == "gmsh"
                         ? "that " + mesh.file + " is a Gmsh file of hexahedra."
                         : "'grid type' and 'grid arguments' against deal.II's GridGenerator."));
  }
  place(triangulation, mesh.placement);
}

} // namespace eunoe
