// A sphere that rolls over the edge of a box without slipping: it has one contact all the time,
// whose memory is kept, the forces are those of a rigid sphere that turns about the edge, and it
// leaves where a rigid sphere does. Reference: energy and angular momentum about the edge; with the
// speed v0 before,
//   v^2 = v0^2 + 10/7 g R (1 - cos a),  N = m g cos a - m v^2 / R,  F = 2/7 m g sin a,
// and N = 0 at cos a = 10/17 + 7/17 v0^2 / (g R). Without friction v^2 = v0^2 + 2 g R (1 - cos a)
// and N = 0 at cos a = 2/3 + v0^2 / (3 g R).

#include "surfaces.h"

using namespace test;

namespace {

/// Where and in which direction the sphere rolls over the box.
struct Way
{
  Vec3 end, direction;
};

struct Result
{
  int other_numbers = 0;
  double largest_change = 0., worst_normal_force = 0., worst_friction = 0., leaving_cosine = 1.;
};

Result run(const Powder &powder, const Way &way, double v0)
{
  const double R = powder.radius(), g = -powder.gravity.y, weight = powder.mass() * g;
  const double gain = powder.friction > 0. ? 10. / 7. : 2.;
  Vec3 start = way.end - 0.6 * R * way.direction;
  start.y = R - powder.overlap(weight);
  const Vec3 spin = powder.friction > 0. ? v0 / R * cross({0., 1., 0.}, way.direction) : Vec3();
  Result result;
  std::vector<double> last;
  Case test_case(box_input(2e-6, 0.05,
                           powder.input() + insertion_input({{start, v0 * way.direction, spin}}) +
                               shape_input("box", "-3e-3,-2e-3,-2e-3 : 0,0,2e-3")));
  test_case.run([&](Simulation &simulation) {
    const TouchingSphere s = spheres(simulation)[0];
    if (result.leaving_cosine < 1.)
      return;
    const double beyond = std::max(0., dot(s.position - way.end, way.direction));
    const double sine = beyond / std::hypot(beyond, s.position.y);
    const double cosine = std::sqrt(1. - sine * sine);
    if (s.normals.empty()) {
      result.leaving_cosine = cosine;
      return;
    }
    result.other_numbers += s.normals.size() == 1 ? 0 : 1;
    double size2 = 0., change2 = 0.;
    for (std::size_t h = 0; h < last.size(); ++h) {
      size2 += last[h] * last[h];
      change2 += (s.memories[0][h] - last[h]) * (s.memories[0][h] - last[h]);
    }
    // Long enough after the start that the memory has grown, and before the contact opens.
    if (simulation.time() > 1e-3 && cosine > 0.8)
      result.largest_change =
          std::max(result.largest_change, size2 > 0. ? std::sqrt(change2 / size2) : 1.);
    last = s.memories[0];

    const Vec3 contact = s.force - powder.mass() * powder.gravity;
    const Vec3 outwards = sine * way.direction + Vec3{0., cosine, 0.};
    const Vec3 backwards = Vec3{0., sine, 0.} - cosine * way.direction;
    const double v2 = v0 * v0 + gain * g * R * (1. - cosine);
    const double normal_force = weight * cosine - powder.mass() * v2 / R;
    const double friction = powder.friction > 0. ? 2. / 7. * weight * sine : 0.;
    // The load jumps at the edge, and the contact takes a while to settle again.
    if (sine > 0.2 && normal_force > 0.1 * weight) {
      result.worst_normal_force = std::max(
          result.worst_normal_force, std::abs(dot(contact, outwards) - normal_force) / weight);
      result.worst_friction =
          std::max(result.worst_friction, std::abs(dot(contact, backwards) - friction) / weight);
    }
  });
  return result;
}

} // namespace

EUNOE_MPI_TEST()
{
  Powder powder;
  powder.gravity = {0., -9.81, 0.};
  powder.restitution = 0.1;
  const double share = 0.1, v0 = std::sqrt(share * 9.81 * powder.radius());
  const double half = std::sqrt(0.5);
  const std::pair<const char *, Way> ways[] = {
      {" over an edge", {{0., 0., 1e-4}, {1., 0., 0.}}},
      {" over a corner", {{0., 0., 2e-3}, {half, 0., half}}}};
  for (const auto &[where, way] : ways)
    for (const char *const motion : {"rolling", "slipping"}) {
      const bool rolls = motion == std::string("rolling");
      powder.friction = rolls ? 5. : 0.;
      powder.rolling_friction = 0.;
      const Result result = run(powder, way, v0);
      const std::string name = motion + std::string(where);
      check("one contact while " + name, result.other_numbers == 0,
            std::to_string(result.other_numbers) + " steps with another number");
      // Overlap and dashpot cause deviations of this size from a rigid sphere.
      check_close("normal force while " + name, result.worst_normal_force, 0., 0.01);
      check_close("friction while " + name, result.worst_friction, 0., 0.004);
      check_close("leaves when " + name, result.leaving_cosine,
                  rolls ? (10. + 7. * share) / 17. : (2. + share) / 3., 0.05);
      powder.friction = 5.;
      powder.rolling_friction = 0.02;
      if (rolls)
        check_close("change of the memory in a step while " + name,
                    run(powder, way, v0).largest_change, 0., 0.01);
    }
}
