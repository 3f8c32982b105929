// A sphere that bounces, slips and rolls over a floor ends in the same state, to the last bit, on a
// wall of the domain, on a floating wall, on two triangles and on a plate of many uneven ones.
// Regression: another program's rebound from a meshed plane differed from that of an analytic one.

#include "../solids/surfaces.h"

using namespace test;

namespace {

const Start start = {{-6e-3, -5e-3, 2e-3}, {0.07, 0.06, 0.1}, {20., 30., 40.}};

TouchingSphere bounce(const std::string &floor)
{
  Powder powder;
  powder.restitution = 0.6;
  powder.friction = 0.3;
  powder.rolling_friction = 0.05;
  powder.gravity = {0., 0., -9.81};
  Case test_case(box_input(1e-5, 0.15, powder.input() + insertion_input({start}) + floor));
  test_case.run();
  return spheres(*test_case)[0];
}

void expect_same(const std::string &name, const TouchingSphere &a, const TouchingSphere &b)
{
  check(name, a.position == b.position && a.velocity == b.velocity && a.spin == b.spin,
        "off by " + format(norm(a.position - b.position)) + " m");
}

} // namespace

EUNOE_MPI_TEST()
{
  const TouchingSphere plane = bounce(walls_input({{{}, {0., 0., 1.}}}));
  check("it rolls, far from where it started",
        plane.position.z < 0.51e-3 && norm(plane.position - start.position) > 5e-3,
        format(plane.position.x) + ", " + format(plane.position.y) + ", " +
            format(plane.position.z));
  const Vec3 corner = {-9e-3, -9e-3, 0.}, along = {18e-3, 0., 0.}, across = {0., 18e-3, 0.};
  expect_same("two triangles",
              bounce(shape_input("plane", text_of(corner) + " : " + text_of(along) + " : " +
                                              text_of(across))),
              plane);
  write_gmsh(uneven_plate(corner, along, across, 40, 30), "plate.msh");
  expect_same("2400 uneven triangles", bounce(gmsh_input("plate.msh")), plane);
  expect_same(
      "wall of the domain",
      bounce("subsection mesh\n set grid arguments = 4, 4, 4 : -0.01, -0.01, 0 : 0.01, 0.01, "
             "0.02 : true\nend\n"),
      plane);
}
