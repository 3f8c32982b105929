#include <eunoe/core/files.h>
#include <eunoe/solids/solid_parameters.h>

#include <map>
#include <sstream>

namespace eunoe {

namespace {

/// Whether an element is a point or a piece of a curve, of whatever order, by its type in Gmsh.
bool is_point_or_line(int type)
{
  return type == 15 || type == 1 || type == 8 || (type >= 26 && type <= 28);
}
constexpr int triangle = 2;

/// A file that is not what it should be.
struct Unreadable
{
};

/// Reads the next values of a stream.
template <typename... Value>
void take(std::istream &stream, Value &...values)
{
  if (!(stream >> ... >> values))
    throw Unreadable();
}

std::istringstream next_line(std::istream &stream)
{
  std::string line;
  if (!std::getline(stream, line))
    throw Unreadable();
  return std::istringstream(line);
}

/// The triangles of a Gmsh file and the nodes that they use.
///
/// deal.II's own reader refuses a surface with the curves that Gmsh writes along its edges, and
/// edges that more than two triangles share.
class GmshReader
{
public:
  TriangleMesh mesh;

  GmshReader(const std::string &text, const std::string &file) : file(file), stream(text)
  {
    std::string word;
    while (stream >> word)
      if (word == "$MeshFormat")
        read_format();
      else if (word == "$Nodes")
        read_nodes();
      else if (word == "$Elements")
        read_elements();
    if (mesh.triangles.empty())
      throw Unreadable();
  }

private:
  void read_format()
  {
    int binary;
    take(stream, version, binary);
    if ((version != "2.2" && version != "4.1") || binary != 0)
      throw Unreadable();
  }

  /// Number of the blocks of a section, which the older format does not have.
  std::size_t read_blocks()
  {
    std::size_t n_blocks = 1, n, smallest, largest;
    if (version == "4.1")
      take(stream, n_blocks, n, smallest, largest);
    return n_blocks;
  }

  void read_nodes()
  {
    for (std::size_t block = read_blocks(); block > 0; --block) {
      unsigned int dimension = 0, entity, parametric = 0;
      std::size_t n;
      if (version == "4.1")
        take(stream, dimension, entity, parametric);
      take(stream, n);
      std::vector<std::size_t> tags;
      const auto take_tag = [&]() {
        tags.emplace_back();
        take(stream, tags.back());
      };
      if (version == "4.1")
        for (std::size_t k = 0; k < n; ++k)
          take_tag();
      for (std::size_t k = 0; k < n; ++k) {
        if (version != "4.1")
          take_tag();
        Vec3 &x = nodes[tags[k]];
        take(stream, x.x, x.y, x.z);
        double parameter;
        for (unsigned int d = 0; d < parametric * dimension; ++d)
          take(stream, parameter);
      }
    }
  }

  void read_elements()
  {
    for (std::size_t block = read_blocks(); block > 0; --block) {
      int dimension, entity, type;
      std::size_t n;
      if (version == "4.1")
        take(stream, dimension, entity, type);
      take(stream, n);
      next_line(stream);
      for (std::size_t k = 0; k < n; ++k) {
        std::istringstream line = next_line(stream);
        std::size_t element, n_tags, tag;
        take(line, element);
        if (version != "4.1")
          for (take(line, type, n_tags); n_tags > 0; --n_tags)
            take(line, tag);
        add_element(type, line);
      }
    }
  }

  void add_element(int type, std::istream &line)
  {
    if (is_point_or_line(type))
      return;
    if (type != triangle)
      throw UserError(file + " has an element that is no triangle. Surfaces of solids are made of "
                             "triangles; switch recombination off in Gmsh.");
    mesh.triangles.emplace_back();
    for (std::int32_t &vertex : mesh.triangles.back()) {
      std::size_t tag;
      take(line, tag);
      const auto node = nodes.find(tag);
      if (node == nodes.end())
        throw Unreadable();
      const auto [used, is_new] =
          vertex_of_tag.emplace(tag, static_cast<std::int32_t>(mesh.vertices.size()));
      if (is_new)
        mesh.vertices.push_back(node->second);
      vertex = used->second;
    }
  }

  const std::string file;
  std::istringstream stream;
  std::string version;
  std::map<std::size_t, Vec3> nodes;
  std::map<std::size_t, std::int32_t> vertex_of_tag;
};

} // namespace

TriangleMesh read_gmsh(const std::string &file, MPI_Comm comm)
{
  try {
    return GmshReader(read_file(file, comm), file).mesh;
  } catch (const Unreadable &) {
    throw UserError(file + " is no Gmsh file (format 2.2 or 4.1, ASCII) of a surface of triangles. "
                           "Export the surface mesh with 'gmsh -2 -format msh2'.");
  }
}

} // namespace eunoe
