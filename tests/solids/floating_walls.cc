// A floating wall has two sides: a sphere on either is pushed away from the plane, and one that is
// pressed beyond it comes back to the side of the search. The normal may have any length and either
// sign. The wall acts from its start to its end: a sphere rests on it, then falls; one that
// overlaps is pushed off when it starts. Reference: geometry; free fall in the steps of velocity
// Verlet; the elastic energy of the overlap. Regression: another program's walls had a wrong
// overlap if their normal was not a unit vector. Half spaces threw everything on one of their sides
// to the other, such as a heap between two walls whose normals are the same.

#include "surfaces.h"

using namespace test;

namespace {

void examine_geometry()
{
  const double R = 1e-3;
  const Vec3 point = {1., 2., 3.}, direction = {2. / 7., -3. / 7., 6. / 7.};
  const Vec3 across = cross(direction, {0.3, 0.1, -0.7});
  double worst = 0., worst_beyond = 0.;
  bool one = true;
  for (const double length : {1e-6, 1., -700.})
    for (const double height : {0.999, 0.5, 1e-3, -1e-3, -0.5, -0.999}) {
      const InfinitePlane wall(point, length * direction);
      const double side = height > 0. ? 1. : -1.;
      const Vec3 centre = point + across + height * R * direction;
      const auto found = contacts(wall, centre, R);
      one = one && found.size() == 1;
      if (!one)
        continue;
      worst = std::max({worst, norm(found[0].normal + side * direction),
                        std::abs(found[0].distance - side * height * R)});

      std::vector<std::int32_t> facets;
      wall.find_facets(centre, R, facets);
      SurfaceContact beyond = {};
      wall.find_contacts(centre - 2. * height * R * direction, R, R, facets.data(),
                         facets.data() + facets.size(), &beyond);
      worst_beyond = std::max({worst_beyond, norm(beyond.normal + side * direction),
                               std::abs(beyond.distance + side * height * R)});
    }
  check("one contact on either side of the plane", one);
  check_close("its distance and normal", worst, 0., 1e-14);
  check_close("the same side for a centre pressed beyond the plane", worst_beyond, 0., 1e-14);
  bool none = true;
  for (const double side : {1., -1.})
    none =
        none &&
        contacts(InfinitePlane(point, direction), point + side * 1.001 * R * direction, R).empty();
  check("none beyond its reach", none);
}

/// Spheres on both sides of a wall, thrown at it.
void bounce_on_both_sides()
{
  Powder powder;
  powder.restitution = 1.;
  const double R = powder.radius();
  Case test_case(box_input(1e-6, 4e-3,
                           powder.input() +
                               insertion_input({{{1.2 * R, 0., 0.}, {-0.1, 0., 0.}, {}},
                                                {{-1.2 * R, 5. * R, 0.}, {0.1, 0., 0.}, {}}}) +
                               walls_input({{{}, {1., 0., 0.}, 0., 1.}})));
  test_case.run();
  const auto found = spheres(*test_case);
  check_relative("back on the side of the normal", found[0].velocity.x, 0.1, 1e-3);
  check_relative("back on the other side", found[1].velocity.x, -0.1, 1e-3);
}

/// A sphere on a wall that ends.
void rest_and_fall()
{
  Powder powder;
  powder.gravity = {0., -9.81, 0.};
  const double dt = 1e-5, height = 1e-3;
  const double rest = height + powder.radius() - powder.overlap(powder.mass() * 9.81);
  constexpr int end = 6000;
  double largest_move = 0., worst_fall = 0.;
  bool held = true, is_free = true;
  Case test_case(
      box_input(dt, 0.08,
                powder.input() + insertion_input({{{0., rest, 0.}, {}, {}}}) +
                    walls_input({{{2e-3, height, 0.}, {0., 0.01, 0.}, 0., (end + 0.5) * dt}})));
  test_case.run([&](Simulation &simulation) {
    const TouchingSphere s = spheres(simulation)[0];
    const auto n = static_cast<int>(simulation.step_number());
    if (n <= end) {
      // A contact is remembered from the first step on.
      held = held && s.normals.size() == (n == 0 ? 0 : 1);
      largest_move = std::max(largest_move, std::abs(s.position.y - rest));
    } else {
      is_free = is_free && s.normals.empty();
      // In the last step of the wall the forces balanced, so the first half step of gravity is
      // missing.
      const double t = (n - end) * dt;
      const double fall = 0.5 * 9.81 * (t * t - t * dt);
      worst_fall = std::max(worst_fall, std::abs(rest - fall - s.position.y));
    }
  });
  check("a contact up to the end of the wall", held);
  check("none after it", is_free);
  check_close("it rests until then", largest_move, 0., 1e-15);
  check_close("it falls freely after it", worst_fall, 0., 1e-14);
}

/// A sphere that overlaps a wall when the wall starts.
void be_pushed()
{
  Powder powder;
  powder.restitution = 1.;
  const double dt = 1e-6, R = powder.radius(), overlap = 0.05 * R;
  const Vec3 direction = {0.6, 0., -0.8};
  constexpr int start = 100;
  bool waits = true;
  Case test_case(box_input(dt, 1e-3,
                           powder.input() + insertion_input({{(R - overlap) * direction, {}, {}}}) +
                               walls_input({{{}, 5. * direction, (start - 0.5) * dt, 1.}})));
  test_case.run([&](Simulation &simulation) {
    const TouchingSphere s = spheres(simulation)[0];
    if (simulation.step_number() < start)
      waits = waits && s.normals.empty() && s.force == Vec3() && s.velocity == Vec3();
    else if (simulation.step_number() == start)
      check_relative("pushed at once", dot(s.force, direction),
                     4. / 3. * Powder::young * std::sqrt(R) * std::pow(overlap, 1.5), 1e-10);
  });
  check("at rest before the start of the wall", waits);
  const Vec3 velocity = spheres(*test_case)[0].velocity;
  const double energy = 8. / 15. * Powder::young * std::sqrt(R) * std::pow(overlap, 2.5);
  check_relative("speed after the push", dot(velocity, direction),
                 std::sqrt(2. * energy / powder.mass()), 1e-3);
  check_close("direction of the push", norm(cross(velocity, direction)), 0., 1e-14);
}

} // namespace

EUNOE_MPI_TEST()
{
  examine_geometry();
  bounce_on_both_sides();
  rest_and_fall();
  be_pushed();
}
