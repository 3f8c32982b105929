// Surfaces from Gmsh: formats 2.2 and 4.1 as Gmsh writes them, with the points and lines of the
// geometry among the elements, closed surfaces, edges where three surfaces meet, and nodes that no
// triangle uses; anything else is refused with a sentence that says what to do.
// Regression: closed surfaces were refused because of the lines along their edges.

#include <eunoe/solids/solid_parameters.h>

#include "surfaces.h"

using namespace test;

namespace {

const std::string no_surface =
    "surface.msh is no Gmsh file (format 2.2 or 4.1, ASCII) of a surface "
    "of triangles. Export the surface mesh with 'gmsh -2 -format msh2'.";
const std::string no_triangle =
    "surface.msh has an element that is no triangle. Surfaces of solids are made of triangles; "
    "switch recombination off in Gmsh.";

/// A tetrahedron in format 2.2, with a point and lines among its elements and a node that only a
/// line uses. The numbers of the nodes are not consecutive.
const std::string closed_22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                              "$PhysicalNames\n1\n2 7 \"blade\"\n$EndPhysicalNames\n"
                              "$Nodes\n5\n11 0 0 0\n2 1 0 0\n30 0 2 0\n4 0 0 3\n5 -9 -9 -9\n"
                              "$EndNodes\n$Elements\n7\n1 15 2 0 1 11\n2 1 2 0 1 11 2\n"
                              "3 1 2 0 2 11 5\n4 2 2 7 1 11 2 30\n5 2 2 7 2 11 2 4\n"
                              "6 2 2 7 3 11 30 4\n7 2 3 7 4 0 2 30 4\n$EndElements\n";

/// The same in format 4.1, with the parameters of nodes on curves and surfaces.
const std::string closed_41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 1 1 0\n1 0 0 0 0\n"
    "1 0 0 0 1 0 0 0 2 1 -2\n1 0 0 0 1 2 3 0 0\n$EndEntities\n$Nodes\n"
    "3 5 2 30\n0 1 0 2\n11\n5\n0 0 0\n-9 -9 -9\n1 1 1 1\n2\n1 0 0 0.25\n"
    "2 1 1 2\n30\n4\n0 2 0 0.5 0.75\n0 0 3 0.1 0.2\n$EndNodes\n$Elements\n"
    "3 7 1 7\n0 1 15 1\n1 11\n1 1 1 2\n2 11 2\n3 11 5\n2 1 2 4\n4 11 2 30\n5 11 2 4\n"
    "6 11 30 4\n7 2 30 4\n$EndElements\n";

std::string replaced(std::string text, const std::string &before, const std::string &after)
{
  return text.replace(text.find(before), before.size(), after);
}

TriangleMesh read(const std::string &text)
{
  write_file("surface.msh", text);
  return read_gmsh("surface.msh", MPI_COMM_WORLD);
}

void examine(const std::string &name, const std::string &text)
{
  try {
    const TriangleMesh mesh = read(text);
    const std::vector<Vec3> corners = {{0., 0., 0.}, {1., 0., 0.}, {0., 2., 0.}, {0., 0., 3.}};
    const int expected[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
    bool same = mesh.triangles.size() == 4 && mesh.vertices.size() == 4;
    for (unsigned int t = 0; t < 4 && same; ++t)
      for (unsigned int c = 0; c < 3; ++c)
        same = same && mesh.vertices[mesh.triangles[t][c]] == corners[expected[t][c]];
    check(name, same);
  } catch (const UserError &error) {
    check(name, false, error.what());
  }
}

void examine_error(const std::string &name, const std::string &text, const std::string &sentence)
{
  std::string answer = "nothing is said";
  try {
    read(text);
  } catch (const UserError &error) {
    answer = error.what();
  }
  check(name, answer == sentence, answer);
}

void examine_closed()
{
  examine("closed surface, format 2.2", closed_22);
  examine("closed surface, format 4.1", closed_41);
  std::string windows;
  for (const char c : closed_22)
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  examine("lines that end as under Windows", windows);
}

void examine_tee()
{
  const TriangleMesh three =
      read("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 0 0 1\n3 1 0 0\n4 -1 0 0\n"
           "5 0 1 0\n$EndNodes\n$Elements\n3\n1 2 2 0 1 1 2 3\n2 2 2 0 2 1 2 4\n3 2 2 0 3 1 2 5\n"
           "$EndElements\n");
  check("an edge of three triangles", three.triangles.size() == 3 && three.defect().empty());
  // Below them two lie in one plane; above, the third divides the space.
  const TriangulatedSurface tee(three);
  check("one contact below an edge of three", contacts(tee, {0., -0.09, 0.5}, 0.1).size() == 1);
  check("two contacts above an edge of three", contacts(tee, {0.08, 0.09, 0.3}, 0.1).size() == 2);
}

void examine_written()
{
  const TriangleMesh mesh = uneven_plate({-1e-3, 2e-3, 0.1}, {1e-3, 0., 0.}, {0., 0., 3e-3}, 7, 4);
  write_gmsh(mesh, "surface.msh");
  const TriangleMesh again = read_gmsh("surface.msh", MPI_COMM_WORLD);
  bool same = again.triangles.size() == mesh.triangles.size();
  for (std::size_t t = 0; t < mesh.triangles.size() && same; ++t)
    for (unsigned int c = 0; c < 3; ++c)
      same = same && again.vertices[again.triangles[t][c]] == mesh.vertices[mesh.triangles[t][c]];
  check("same bits written and read", same);
}

void examine_other_elements()
{
  examine_error("quadrilateral, format 2.2",
                replaced(closed_22, "7 2 3 7 4 0 2 30 4", "7 3 2 7 4 11 2 30 4"), no_triangle);
  examine_error("quadrilateral, format 4.1", replaced(closed_41, "2 1 2 4\n", "2 1 3 4\n"),
                no_triangle);
  examine_error("triangle of second order",
                replaced(closed_22, "7 2 3 7 4 0 2 30 4", "7 9 2 7 4 11 2 30 4 5 5"), no_triangle);
  examine_error("tetrahedron", replaced(closed_22, "7 2 3 7 4 0 2 30 4", "7 4 2 7 4 11 2 30 4"),
                no_triangle);
  examine_error("only lines",
                closed_22.substr(0, closed_22.find("$Elements")) +
                    "$Elements\n1\n2 1 2 0 1 11 2\n$EndElements\n",
                no_surface);
  examine_error("binary file", replaced(closed_22, "2.2 0 8", "2.2 1 8"), no_surface);
  examine_error("other version", replaced(closed_22, "2.2 0 8", "1 0 8"), no_surface);
  examine_error("node that does not exist", replaced(closed_22, "2 30 4\n$End", "2 31 4\n$End"),
                no_surface);
  examine_error("coordinate that is no number", replaced(closed_22, "0 2 0", "0 two 0"),
                no_surface);
  examine_error("coordinate that is not a number", replaced(closed_22, "0 2 0", "0 nan 0"),
                no_surface);
  for (const std::string *text : {&closed_22, &closed_41})
    examine_error("half a file", text->substr(0, text->size() - 30), no_surface);
}

void examine_garbage()
{
  std::string garbage;
  std::mt19937 generator(1);
  for (int k = 0; k < 5000; ++k)
    garbage += static_cast<char>(generator() & 255);
  examine_error("garbage", garbage, no_surface);
  examine_error("garbage after a good beginning", closed_22.substr(0, 40) + "$Nodes\n" + garbage,
                no_surface);
  examine_error("empty file", "", no_surface);
}

void examine_missing()
{
  std::string answer;
  try {
    read_gmsh("missing.msh", MPI_COMM_WORLD);
  } catch (const UserError &error) {
    answer = error.what();
  }
  check("missing file",
        answer == "missing.msh cannot be read: No such file or directory. Check the name and the "
                  "permissions.",
        answer);
}

} // namespace

EUNOE_MPI_TEST()
{
  examine_closed();
  examine_tee();
  examine_written();
  examine_other_elements();
  examine_garbage();
  examine_missing();
}
