// Checks that a Gmsh file has a background mesh. deal.II's reader accepts cells of any kind and
// fails later, with a message that does not give the cause.

#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/gmsh_file.h>
#include <eunoe/core/problems.h>
#include <eunoe/domain/mesh.h>

#include <map>
#include <set>
#include <unordered_set>

namespace eunoe {

namespace {

/// What a file holds, by the type of the elements.
std::map<int, std::size_t> count_elements(const std::string &text)
{
  std::map<int, std::size_t> numbers;
  std::unordered_set<std::size_t> nodes;
  gmsh::read(
      text, [&nodes](std::size_t tag, const Vec3 &) { nodes.insert(tag); },
      [&](int type, std::istream &line) {
        ++numbers[type];
        std::set<std::size_t> corners;
        for (std::size_t tag; line >> tag; corners.insert(tag))
          if (nodes.count(tag) == 0)
            throw gmsh::Unreadable{"has an element with node " + std::to_string(tag) +
                                   ", which is not there"};
        constexpr std::size_t n_corners = 8;
        if (type == gmsh::hexahedron && corners.size() != n_corners)
          throw gmsh::Unreadable{"has a hexahedron of " + std::to_string(corners.size()) +
                                 " corners instead of 8"};
      });
  return numbers;
}

const std::string advice =
    " The background mesh is made of hexahedra alone. In Gmsh, 'Mesh.SubdivisionAlgorithm = 2;' "
    "makes hexahedra of any volume; so do transfinite volumes with 'Recombine'.";

/// What keeps the elements from being a background mesh, empty if nothing does.
std::string find_defect(const std::map<int, std::size_t> &numbers)
{
  std::string wrong, flat;
  bool is_curved = false, has_triangles = false;
  for (const auto &[type, n] : numbers) {
    const gmsh::ElementKind *const kind = gmsh::find_kind(type);
    std::string counted = std::to_string(n) + " " +
                          (kind == nullptr ? "elements of Gmsh's type " + std::to_string(type)
                                           : std::string(kind->name));
    const int order = kind == nullptr ? 1 : kind->order;
    if (order > 1)
      counted += " of order " + std::to_string(order);
    if (type == gmsh::hexahedron || (kind != nullptr && kind->dimension < 2))
      continue;
    is_curved = is_curved || order > 1;
    has_triangles = has_triangles || type == gmsh::triangle;
    std::string &list = kind != nullptr && kind->dimension == 2 ? flat : wrong;
    list += (list.empty() ? "" : " and ") + counted;
  }
  if (!wrong.empty())
    return "has " + wrong + "." +
           (is_curved ? " Straight ones are needed: set 'Mesh.ElementOrder = 1;'." : "") + advice;
  if (numbers.count(gmsh::hexahedron) == 0)
    return "has " + (flat.empty() ? "no cells" : flat + " and no volume") +
           ". Mesh the volume ('gmsh -3'); if there are physical groups, Gmsh saves only what is "
           "in one, so that the volume needs a 'Physical Volume'." +
           advice;
  if (has_triangles)
    return "has " + flat + " beside its hexahedra, whose faces are quadrilaterals." + advice;
  return "";
}

} // namespace

std::string read_background_mesh(const MeshParameters &mesh, MPI_Comm comm)
{
  const std::string where = describe(mesh.path, "file name") + ": ";
  std::string text;
  try {
    text = read_file(mesh.file, comm);
  } catch (const UserError &error) {
    throw UserError(where + error.what());
  }
  on_first_rank(comm, [&] {
    std::string defect;
    try {
      defect = find_defect(count_elements(text));
    } catch (const gmsh::Unreadable &problem) {
      defect = (problem.reason.empty() ? "is no Gmsh file, or is cut short" : problem.reason) +
               ". Export the mesh with 'gmsh -3 -format msh22' (format 2.2 or 4.1, ASCII).";
    }
    if (!defect.empty())
      throw UserError(where + mesh.file + " " + defect);
  });
  return text;
}

} // namespace eunoe
