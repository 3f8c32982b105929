#include <eunoe/core/gmsh_file.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

namespace eunoe::gmsh {

namespace {

std::istringstream next_line(std::istream &stream)
{
  std::string line;
  if (!std::getline(stream, line))
    throw Unreadable();
  return std::istringstream(line);
}

class Reader
{
public:
  Reader(const std::string &text, const std::function<void(std::size_t, const Vec3 &)> &on_node,
         const std::function<void(int, std::istream &)> &on_element)
      : stream(text), on_node(on_node), on_element(on_element)
  {
  }

  void read()
  {
    std::string word;
    while (stream >> word)
      if (word == "$MeshFormat")
        read_format();
      else if (word == "$Nodes")
        read_nodes();
      else if (word == "$Elements")
        read_elements();
    if (version.empty())
      throw Unreadable();
  }

private:
  void read_format()
  {
    int binary;
    take(stream, version, binary);
    if (binary != 0)
      throw Unreadable{"is binary"};
    has_blocks = version[0] == '4';
    is_newest = version == "4.1";
    const std::set<std::string> known = {"2", "2.1", "2.2", "4", "4.1"};
    if (known.count(version) == 0)
      throw Unreadable{"is of format " + version.substr(0, 10)};
  }

  /// Number of the blocks of a section, which the older formats do not have.
  std::size_t read_blocks()
  {
    if (version.empty())
      throw Unreadable();
    std::size_t n_blocks = 1, n, smallest, largest;
    if (has_blocks)
      take(stream, n_blocks, n);
    if (is_newest)
      take(stream, smallest, largest);
    return n_blocks;
  }

  void read_nodes()
  {
    for (std::size_t block = read_blocks(); block > 0; --block) {
      unsigned int dimension = 0, entity, parametric = 0;
      std::size_t n;
      if (is_newest)
        take(stream, dimension, entity, parametric);
      else if (has_blocks)
        take(stream, entity, dimension, parametric);
      take(stream, n);
      std::vector<std::size_t> tags;
      const auto take_tag = [&]() {
        tags.emplace_back();
        take(stream, tags.back());
      };
      if (is_newest)
        for (std::size_t k = 0; k < n; ++k)
          take_tag();
      for (std::size_t k = 0; k < n; ++k) {
        if (!is_newest)
          take_tag();
        Vec3 x;
        take(stream, x.x, x.y, x.z);
        on_node(tags[k], x);
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
      if (has_blocks)
        take(stream, dimension, entity, type);
      take(stream, n);
      next_line(stream);
      for (std::size_t k = 0; k < n; ++k) {
        std::istringstream line = next_line(stream);
        std::size_t element, n_tags, tag;
        take(line, element);
        if (!has_blocks)
          for (take(line, type, n_tags); n_tags > 0; --n_tags)
            take(line, tag);
        on_element(type, line);
      }
    }
  }

  std::istringstream stream;
  const std::function<void(std::size_t, const Vec3 &)> &on_node;
  const std::function<void(int, std::istream &)> &on_element;
  std::string version;
  bool has_blocks = false, is_newest = false;
};

/// From Gmsh's manual.
constexpr ElementKind kinds[] = {{15, 0, 1, "points"},
                                 {1, 1, 1, "lines"},
                                 {8, 1, 2, "lines"},
                                 {26, 1, 3, "lines"},
                                 {27, 1, 4, "lines"},
                                 {28, 1, 5, "lines"},
                                 {triangle, 2, 1, "triangles"},
                                 {9, 2, 2, "triangles"},
                                 {20, 2, 3, "triangles"},
                                 {21, 2, 3, "triangles"},
                                 {quadrilateral, 2, 1, "quadrilaterals"},
                                 {10, 2, 2, "quadrilaterals"},
                                 {16, 2, 2, "quadrilaterals"},
                                 {36, 2, 3, "quadrilaterals"},
                                 {4, 3, 1, "tetrahedra"},
                                 {11, 3, 2, "tetrahedra"},
                                 {29, 3, 3, "tetrahedra"},
                                 {hexahedron, 3, 1, "hexahedra"},
                                 {12, 3, 2, "hexahedra"},
                                 {17, 3, 2, "hexahedra"},
                                 {92, 3, 3, "hexahedra"},
                                 {6, 3, 1, "prisms"},
                                 {13, 3, 2, "prisms"},
                                 {18, 3, 2, "prisms"},
                                 {90, 3, 3, "prisms"},
                                 {7, 3, 1, "pyramids"},
                                 {14, 3, 2, "pyramids"},
                                 {19, 3, 2, "pyramids"},
                                 {118, 3, 3, "pyramids"}};

} // namespace

void read(const std::string &text, const std::function<void(std::size_t, const Vec3 &)> &on_node,
          const std::function<void(int, std::istream &)> &on_element)
{
  Reader(text, on_node, on_element).read();
}

const ElementKind *find_kind(const int type)
{
  const auto kind = std::find_if(std::begin(kinds), std::end(kinds),
                                 [type](const ElementKind &k) { return k.type == type; });
  return kind == std::end(kinds) ? nullptr : kind;
}

} // namespace eunoe::gmsh
