// Cylinders as background meshes: a sphere bounces along chords, with mesh cells of two sizes, and
// a sphere at rest slips on a wall that turns. References: closed formulas.

#include <eunoe/solids/half_space.h>
#include <eunoe/solids/triangulated_surface.h>

#include "meshes.h"

using namespace test;

namespace {

constexpr double R = 40e-3, r = 0.5e-3;

/// A cylinder about the x-axis with 4 * 2^refinement facets around.
std::string cylinder(unsigned int refinement, const std::string &more = "")
{
  return generated_mesh("subdivided_cylinder", "2 : 0.04 : 0.02", refinement, more);
}

double apothem(unsigned int refinement)
{
  return R * std::cos(M_PI / (4 << refinement));
}

/// Direction of the middle of a facet nearest to an angle.
double middle_of_facet(double angle, unsigned int refinement)
{
  const double width = 2. * M_PI / (4 << refinement);
  // The corners of the coarse mesh are on the diagonals.
  return (std::floor((angle - M_PI / 4.) / width) + 0.5) * width + M_PI / 4.;
}

/// Duration of an elastic impact on a plane (Hertz; Johnson, Contact Mechanics, 1985, 11.24).
double duration_of_impact(double speed)
{
  const double mass = 1000. * 4. / 3. * M_PI * r * r * r, young = 1e6 / (2. * (1. - 0.09));
  return 2.9432 * std::pow(15. * mass / (16. * std::sqrt(r) * young), 0.4) * std::pow(speed, -0.2);
}

void bounces(const std::string &name, unsigned int refinement, const Vec3 &shift,
             const std::string &placement)
{
  // The first chord goes from the middle of a facet to that of the facet a quarter of a turn on.
  const double angle = middle_of_facet(0.3, refinement), speed = 2.;
  const auto on_ring = [&](double a, double radius) {
    return Vec3{0., radius * std::cos(a), radius * std::sin(a)};
  };
  const double inner = apothem(refinement) - r;
  const Vec3 from = on_ring(angle, inner), to = on_ring(angle + 0.5 * M_PI, inner);
  const Vec3 along = (to - from) / norm(to - from);
  Case test_case(control(5e-6, 0.25) + cylinder(refinement, placement) +
                 powder(2. * r, 1., 0., "0, 0, 0") +
                 "subsection model parameters\n subsection contact detection\n"
                 "  set neighborhood threshold = 1.05\n end\nend\n" +
                 places({shift + 0.5 * (from + to)}, {speed * along + Vec3{0.01, 0., 0.}}));

  unsigned int bounces = 0;
  double closest = R, furthest = 0., slowest = 2. * speed, fastest = 0.;
  bool touched = false;
  test_case.run([&](Simulation &simulation) {
    const std::vector<double> row = particle_table(simulation)[0];
    const Vec3 x = {0., row[c_y] - shift.y, row[c_z] - shift.z}, v = {0., row[c_vy], row[c_vz]};
    const bool touches = norm(x) > inner;
    if (touches && !touched)
      ++bounces;
    touched = touches;
    if (norm(x) > 0.95 * inner)
      return;
    // Distance of the present chord from the axis.
    const double chord = norm(cross(x, v)) / norm(v);
    closest = std::min(closest, chord);
    furthest = std::max(furthest, chord);
    slowest = std::min(slowest, norm(v));
    fastest = std::max(fastest, norm(v));
  });
  // The paths before and after an impact, extended, meet behind the wall, so every other chord is
  // further from the axis.
  const double depth = 0.5 * std::sqrt(0.5) * speed * duration_of_impact(std::sqrt(0.5) * speed);
  const double chord = std::sqrt(0.5) * inner;
  check(name + ": it bounced", bounces >= 8, std::to_string(bounces) + " times");
  check_relative(name + ": the nearer chords", closest, chord, 5e-4);
  check_relative(name + ": the further chords", furthest, chord + std::sqrt(2.) * depth, 5e-4);
  check_relative(name + ": slowest", slowest, speed, 1e-3);
  check_relative(name + ": fastest", fastest, speed, 1e-3);
}

/// The curved wall is made of the facets of the mesh, the flat ends are planes.
void shapes()
{
  Case test_case(control(1e-5, 1e-5) + cylinder(3) + powder(2. * r, 1., 0., "0, 0, 0"));
  unsigned int planes = 0, surfaces = 0;
  double least = 1., most = 0.;
  for (const Solid &wall : test_case->get_domain().walls()) {
    planes += dynamic_cast<const HalfSpace *>(wall.shape.get()) != nullptr ? 1 : 0;
    if (dynamic_cast<const TriangulatedSurface *>(wall.shape.get()) == nullptr)
      continue;
    ++surfaces;
    for (const Vec3 &corner : wall.shape->triangles()) {
      const double radius = std::hypot(corner.y, corner.z);
      least = std::min(least, radius);
      most = std::max(most, radius);
    }
  }
  check("two planes", planes == 2);
  check("one surface", surfaces == 1);
  check_relative("its corners are on the cylinder", least, R, 1e-12);
  check_relative("all of them", most, R, 1e-12);
}

/// A sphere at rest on a wall that turns: while it slips, friction gives its speed and spin and the
/// torque on the wall.
void drum()
{
  const unsigned int refinement = 3;
  const double friction = 0.3, g = 9.81, angle = middle_of_facet(-0.5 * M_PI + 0.01, refinement);
  // Gravity acts along the normal of the facet under the sphere.
  const Vec3 out = {0., std::cos(angle), std::sin(angle)}, along = cross({1., 0., 0.}, out);
  const double density = 1000., mass = density * 4. / 3. * M_PI * r * r * r;
  const double young = 1e6 / (2. * (1. - 0.09));
  const double overlap = std::pow(mass * g / (4. / 3. * young * std::sqrt(r)), 2. / 3.);
  std::ostringstream gravity;
  gravity.precision(17);
  gravity << g * out.x << ", " << g * out.y << ", " << g * out.z;
  Case test_case(
      control(1e-5, 4e-3) + cylinder(refinement) + powder(2. * r, 0.5, friction, gravity.str()) +
      "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
      " subsection boundary condition 0\n  set type = rotational\n  set boundary id = 0\n"
      "  set rotational speed = 20\n  set rotational vector = 1, 0, 0\n"
      "  set point on rotational vector = 3, 0, 0\n end\nend\n"
      "subsection boundary forces\n set calculation = true\n set output frequency = 100\n"
      "end\n" +
      places({(apothem(refinement) - r + overlap) * out}, {Vec3()}));
  test_case.run();
  const std::vector<double> row = particle_table(*test_case)[0];
  const double time = 4e-3, slope = 0.02;
  check_relative("sliding: speed", dot({row[c_vx], row[c_vy], row[c_vz]}, along),
                 friction * g * time, slope);
  check_relative("sliding: spin", row[c_wx], 2.5 * friction * g * time / r, slope);
  double torque = 0.;
  for (const SolidLoad &load : test_case->global_solid_loads())
    torque += load.torque[0].value();
  check_relative("torque on the drum", torque, -friction * mass * g * (apothem(refinement)), slope);
}

/// How much of its speed a sphere without friction keeps that hits a facet of a drum beside its
/// middle, where w x r has a part along the facet's normal.
double rebound_beside_middle(double rotational_speed)
{
  const unsigned int refinement = 2;
  const double angle = middle_of_facet(0.3, refinement), speed = 0.1, aside = 0.25;
  const Vec3 out = {0., std::cos(angle), std::sin(angle)}, along = cross({1., 0., 0.}, out);
  const double width = 2. * R * std::sin(M_PI / (4 << refinement));
  const Vec3 start = (apothem(refinement) - 1.1 * r) * out + aside * width * along;
  Case test_case(
      control(5e-6, 8e-3) + cylinder(refinement) + powder(2. * r, 0.3, 0., "0, 0, 0") +
      "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
      " subsection boundary condition 0\n  set type = rotational\n  set boundary id = 0\n"
      "  set rotational speed = " +
      std::to_string(rotational_speed) +
      "\n  set rotational vector = 1, 0, 0\n  set point on rotational vector = 3, 0, 0\n "
      "end\nend\n" +
      places({start}, {speed * out}));
  test_case.run();
  const std::vector<double> row = particle_table(*test_case)[0];
  return -dot({row[c_vx], row[c_vy], row[c_vz]}, out) / speed;
}

void turning_facets_push_nobody()
{
  const double at_rest = rebound_beside_middle(0.);
  check_relative("restitution on a drum at rest", at_rest, 0.3, 0.03);
  for (const double speed : {-10., 10.})
    check_relative("the same while it turns at " + std::to_string(speed),
                   rebound_beside_middle(speed), at_rest, 1e-9);
}

} // namespace

EUNOE_MPI_TEST()
{
  shapes();
  bounces("16 facets", 2, Vec3(), "");
  bounces("32 facets", 3, Vec3(), "");
  bounces("shifted", 3, {0.02, -0.03, 0.04}, " set initial translation = 0.02, -0.03, 0.04\n");
  drum();
  turning_facets_push_nobody();
}
