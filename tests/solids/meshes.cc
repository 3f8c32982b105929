// Defects of surfaces are found, and surfaces without a defect are accepted; corners that coincide
// are merged, so that patches made separately form one surface.

#include "surfaces.h"

using namespace test;

namespace {

void examine(const std::string &name, const TriangleMesh &mesh, const std::string &sentence)
{
  check(name, mesh.defect() == sentence, "'" + mesh.defect() + "'");
}

TriangleMesh triangle(const Vec3 &a, const Vec3 &b, const Vec3 &c)
{
  TriangleMesh mesh;
  mesh.vertices = {{0., 0., 0.}, {1., 0., 0.}, {0., 1., 0.}, a, b, c};
  mesh.triangles = {{{0, 1, 2}}, {{3, 4, 5}}};
  return mesh;
}

void examine_corners()
{
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  examine("nothing", TriangleMesh(), "it has no triangles");
  for (const std::int32_t corner : {-1, 6, 1000000}) {
    TriangleMesh mesh = triangle({0., 0., 1.}, {1., 0., 1.}, {0., 1., 1.});
    mesh.triangles[1][2] = corner;
    examine("corner " + std::to_string(corner), mesh,
            "triangle 1 names a corner that does not exist");
    mesh.vertices.clear();
    examine("no corners at all", mesh, "triangle 0 names a corner that does not exist");
  }
  for (const double value : {nan, inf})
    for (unsigned int d = 0; d < 3; ++d) {
      Vec3 x = {1., 2., 3.};
      x[d] = value;
      examine("a coordinate that is not finite", triangle({0., 0., 1.}, x, {0., 1., 1.}),
              "triangle 1 has a corner that is not a number");
    }
}

void examine_flat_triangles()
{
  const std::string flat = "triangle 1 is degenerate: its corners lie on one line";
  examine("all corners in one place", triangle({1., 1., 1.}, {1., 1., 1.}, {1., 1., 1.}), flat);
  examine("two corners in one place", triangle({1., 1., 1.}, {1., 1., 1.}, {2., 1., 1.}), flat);
  examine("corners on a line", triangle({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.7, 0.7, 0.7}), flat);
  TriangleMesh twice = triangle({0., 0., 1.}, {1., 0., 1.}, {0., 1., 1.});
  twice.triangles[1] = {{4, 3, 4}};
  examine("a corner named twice", twice, flat);
  examine("a speck", triangle({0., 0., 0.}, {1e-13, 0., 0.}, {0., 1e-13, 0.}), flat);
  examine("a needle", triangle({0., 0., 1.}, {1., 0., 1.}, {0.5, 1e-8, 1.}), "");
  examine("a tiny triangle", triangle({0., 0., 1.}, {1e-9, 0., 1.}, {0., 1e-9, 1.}), "");
  examine(
      "the same in micrometres",
      [] {
        TriangleMesh mesh = triangle({0., 0., 1.}, {1., 0., 1.}, {0., 1., 1.});
        for (Vec3 &x : mesh.vertices)
          x *= 1e-6;
        return mesh;
      }(),
      "");
}

void examine_merging()
{
  // The three corners near the origin form a chain with links of 1 and 1.4 mm.
  TriangleMesh row;
  row.vertices = {{3., 0., 0.}, {0., 0., 0.},          {0., 0.5, 0.}, {1e-3, 0., 0.},
                  {3., 0., 0.}, {-1e-3, 0., 0.999e-3}, {3., 1., 0.},  {3., 2e-3, 0.}};
  row.triangles = {{{0, 1, 2}}, {{3, 4, 5}}, {{6, 7, 0}}};
  row.merge_vertices(1.5e-3);
  const auto at = [&](unsigned int t, unsigned int c) { return row.triangles[t][c]; };
  check("corners at no distance are one", at(0, 0) == at(1, 1) && at(0, 0) == at(2, 2));
  check("corners within the tolerance are one", at(0, 1) == at(1, 2) || at(0, 1) == at(1, 0));
  check("corners apart stay apart", at(0, 2) != at(0, 1) && at(2, 1) != at(2, 2) &&
                                        at(2, 0) != at(2, 1) && at(0, 0) != at(0, 1));
}

/// Spheres that touch two plates which meet at x = 0.
/// @return how many of them do not have one contact, straight below
int n_wrong_over_seam(const TriangulatedSurface &plates, const double R)
{
  int wrong = 0;
  for (double x = -0.5 * R; x < 0.5 * R; x += 1e-3 * R) {
    const Vec3 centre = {x, 0.9 * R, 0.37e-3};
    const auto found = contacts(plates, centre, R);
    wrong += found.size() == 1 && std::abs(found[0].distance - centre.y) < 1e-6 * R ? 0 : 1;
  }
  return wrong;
}

void examine_seam_without_common_corners()
{
  // One plate has a long edge where the other has two short ones, and the corner between them lies
  // beside the long edge by as much as single precision leaves.
  const double R = 1e-4;
  for (const double beside : {0., 1e-10}) {
    TriangleMesh plates = shapes::plane({-1e-3, 0., 0.}, {1e-3, 0., 0.}, {0., 0., 1e-3});
    plates.add_quad({0., 0., 0.}, {beside, beside, 0.4e-3}, {1e-3, 0., 0.4e-3}, {1e-3, 0., 0.});
    plates.add_quad({beside, beside, 0.4e-3}, {0., 0., 1e-3}, {1e-3, 0., 1e-3}, {1e-3, 0., 0.4e-3});
    const int wrong = n_wrong_over_seam(TriangulatedSurface(plates), R);
    check("one contact where a long edge meets two short ones", wrong == 0,
          std::to_string(wrong) + " have not");
  }
}

void examine_seam()
{
  // Two plates made separately, whose common edges agree to round-off only.
  const double R = 1e-4, gap = 1e-15;
  TriangleMesh plates = shapes::plane({-1e-3, 0., 0.}, {1e-3, 0., 0.}, {0., 0., 1e-3});
  plates.add_quad({gap, 0., 0.}, {gap, gap, 1e-3}, {1e-3, 0., 1e-3}, {1e-3, 0., 0.});
  const TriangulatedSurface seamless(plates);
  plates.vertices[4].y = plates.vertices[5].y = 1e-2 * R;
  const TriangulatedSurface stepped(plates);
  const int wrong = n_wrong_over_seam(seamless, R);
  int steps = 0;
  for (double x = -0.5 * R; x < 0.5 * R; x += 1e-3 * R)
    steps += contacts(stepped, {x, 0.9 * R, 0.37e-3}, R).size() > 1 ? 1 : 0;
  check("one contact over the seam", wrong == 0, std::to_string(wrong) + " have not");
  check("a step is no seam", steps > 0);
}

} // namespace

EUNOE_TEST()
{
  examine_corners();
  examine_flat_triangles();
  examine_merging();
  examine_seam();
  examine_seam_without_common_corners();
}
