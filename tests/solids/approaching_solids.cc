// A moving solid is found in time, however far away it was and however fast it comes; one at rest
// causes no searches. Reference: elastic impact of a solid with a prescribed motion, which gives a
// sphere twice the velocity of the solid's surface, w x r if the solid turns.

#include "surfaces.h"

using namespace test;

namespace {

/// Velocity of a sphere that was at rest, after a solid has hit it.
Vec3 hit(const std::string &solid, const Vec3 &position, double dt, double time)
{
  Powder powder;
  powder.restitution = 1.;
  powder.friction = 0.;
  Case test_case(
      box_input(dt, time, powder.input() + insertion_input({{position, {}, {}}}) + solid));
  test_case.run();
  const TouchingSphere s = spheres(*test_case)[0];
  check("the solid has passed on", s.normals.empty() && test_case->get_system().n_searches() > 2);
  return s.velocity;
}

/// Number of searches while a sphere is at rest far from a solid.
unsigned long long searches(const std::string &solid, int n_steps)
{
  unsigned long long at_start = 0;
  Case test_case(box_input(1e-5, n_steps * 1e-5,
                           Powder().input() + insertion_input({{{5e-3, 0., 0.}, {}, {}}}) + solid));
  test_case.run([&](Simulation &simulation) {
    if (simulation.step_number() == 0)
      at_start = simulation.get_system().n_searches();
  });
  return test_case->get_system().n_searches() - at_start;
}

} // namespace

EUNOE_MPI_TEST()
{
  check("a solid at rest asks for no search",
        searches(shape_input("plane", "-8e-3,-2e-3,-2e-3 : 0,4e-3,0 : 0,0,4e-3"), 100) == 0);
  // It moves by 1 mm; a search is due after 80 % of the skin of 0.3 mm.
  check("a slow solid asks for few",
        searches(shape_input("plane", "-8e-3,-2e-3,-2e-3 : 0,4e-3,0 : 0,0,4e-3",
                             motion_input("0.1; 0; 0", "0; 0; 0", {})),
                 1000) == 4);

  const Vec3 fast = hit(shape_input("plane", "-8e-3,-2e-3,-2e-3 : 0,4e-3,0 : 0,0,4e-3",
                                    motion_input("2; 0; 0", "0; 0; 0", {})),
                        {2e-3, 0., 0.}, 2e-6, 6e-3);
  check_relative("speed after a fast plate", fast.x, 2. * 2., 1e-4);
  check_close("direction after a fast plate", std::hypot(fast.y, fast.z), 0., 1e-12);
  // The sphere is 5 mm from the axis of a paddle, a quarter of a turn away from its arm.
  const Vec3 paddle = hit(shape_input("plane", "0,-2e-3,-7e-3 : 0,4e-3,0 : 0,0,14e-3",
                                      motion_input("0; 0; 0", "0; 40; 0", {})),
                          {5e-3, 0., 0.}, 2e-6, 0.06);
  // It turns by another 0.01 rad while it touches.
  check_relative("speed after a paddle", norm(paddle), 2. * 40. * 5e-3, 0.01);
}
