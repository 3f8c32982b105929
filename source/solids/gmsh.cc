#include <eunoe/core/files.h>
#include <eunoe/core/gmsh_file.h>
#include <eunoe/solids/solid_parameters.h>

#include <map>

namespace eunoe {

namespace {

/// The triangles of a Gmsh file and the nodes that they use.
///
/// deal.II's own reader refuses a surface with the curves that Gmsh writes along its edges, and
/// edges that more than two triangles share.
class SurfaceReader
{
public:
  TriangleMesh mesh;

  SurfaceReader(const std::string &text, const std::string &file) : file(file)
  {
    gmsh::read(
        text, [this](std::size_t tag, const Vec3 &place) { nodes[tag] = place; },
        [this](int type, std::istream &line) { add_element(type, line); });
    if (mesh.triangles.empty())
      throw gmsh::Unreadable();
  }

private:
  void add_element(int type, std::istream &line)
  {
    const gmsh::ElementKind *const kind = gmsh::find_kind(type);
    if (kind != nullptr && kind->dimension < 2)
      return;
    if (type != gmsh::triangle)
      throw UserError(file + " has an element that is no triangle. Surfaces of solids are made of "
                             "triangles; switch recombination off in Gmsh.");
    mesh.triangles.emplace_back();
    for (std::int32_t &vertex : mesh.triangles.back()) {
      std::size_t tag;
      gmsh::take(line, tag);
      const auto node = nodes.find(tag);
      if (node == nodes.end())
        throw gmsh::Unreadable();
      const auto [used, is_new] =
          vertex_of_tag.emplace(tag, static_cast<std::int32_t>(mesh.vertices.size()));
      if (is_new)
        mesh.vertices.push_back(node->second);
      vertex = used->second;
    }
  }

  const std::string file;
  std::map<std::size_t, Vec3> nodes;
  std::map<std::size_t, std::int32_t> vertex_of_tag;
};

} // namespace

TriangleMesh read_gmsh(const std::string &file, MPI_Comm comm)
{
  try {
    return SurfaceReader(read_file(file, comm), file).mesh;
  } catch (const gmsh::Unreadable &) {
    throw UserError(file + " is no Gmsh file (format 2.2 or 4.1, ASCII) of a surface of triangles. "
                           "Export the surface mesh with 'gmsh -2 -format msh2'.");
  }
}

} // namespace eunoe
