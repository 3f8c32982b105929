#ifndef eunoe_core_gmsh_file_h
#define eunoe_core_gmsh_file_h

// Files of Gmsh, formats 2 to 2.2, 4 and 4.1, ASCII.

#include <eunoe/core/vec3.h>

#include <functional>
#include <istream>
#include <string>
#include <vector>

namespace eunoe::gmsh {

/// A file that is not what it should be.
struct Unreadable
{
  std::string reason; ///< "is binary"; empty for text that makes no sense
};

/// Reads the next values of a stream.
template <typename... Value>
void take(std::istream &stream, Value &...values)
{
  if (!(stream >> ... >> values))
    throw Unreadable();
}

/// Shows all nodes and then all elements of a file. Throws an Unreadable.
/// @param on_node takes a node's number and place
/// @param on_element takes the type of an element and a stream that holds the numbers of its nodes
void read(const std::string &text, const std::function<void(std::size_t, const Vec3 &)> &on_node,
          const std::function<void(int, std::istream &)> &on_element);

/// What the elements of a type are called, "tetrahedra".
struct ElementKind
{
  int type;
  int dimension;
  int order;
  const char *name;
};

/// Null for a type that is not known here.
const ElementKind *find_kind(int type);

constexpr int triangle = 2, quadrilateral = 3, hexahedron = 5;

} // namespace eunoe::gmsh

#endif
