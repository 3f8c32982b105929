// Oblique and spinning impacts that slide throughout: the impulse of friction is mu times the
// normal impulse, against the slip, and its lever arm is the radius (Chung and Ooi 2011, tests 4, 6
// and 7). They determine all signs of slip, friction and torque.

#include "../spheres.h"

using namespace test;

namespace {

// The impulse of friction is mu times that of |F_n|, and damping makes F_n attractive at the end of
// the impact: for e = 0.98 that adds some 1e-4 of the impulse.
const double tolerance = 5e-4;
const double speed = 3.9, radius = 2.5e-3;

Scene scene(double young, double poisson, double density, double friction, double restitution)
{
  Scene s;
  s.particle.young_modulus = young;
  s.particle.poisson_ratio = poisson;
  s.particle.friction = friction;
  s.particle.restitution = restitution;
  s.wall = s.particle;
  s.density = density;
  s.spheres.resize(1);
  s.spheres[0].diameter = 2. * radius;
  s.spheres[0].x.z = radius;
  s.floor = true;
  return s;
}

/// Runs through an impact at normal speed @p v_n.
std::vector<Sphere> collide(Scene &s, double v_n)
{
  const double mass = s.mass(s.spheres[0]) / s.spheres.size();
  const double r = radius / s.spheres.size();
  const double duration = Impact(s.particle, s.particle, mass, r, v_n).duration();
  s.time_step = duration / 10000.;
  s.time_end = 1.5 * duration;
  return run(s);
}

void oblique(const std::string &metal, double young, double poisson, double density)
{
  const double mu = 0.092, e = 0.98;
  for (const double degrees : {40., 50., 65., 85.})
    for (const bool limit_force : {false, true}) {
      Scene s = scene(young, poisson, density, mu, e);
      s.limit_force = limit_force;
      const double angle = degrees * M_PI / 180., v_n = speed * std::cos(angle),
                   v_t = speed * std::sin(angle);
      // The tangential direction is not along an axis.
      const Vec3 along = {0.6, -0.8, 0.};
      s.spheres[0].v = v_t * along - Vec3{0., 0., v_n};
      const Sphere after = collide(s, v_n).at(0);
      const std::string name = metal + " at " + format(degrees) + " degrees, " +
                               (limit_force ? "limit force: " : "limit overlap: ");
      check_relative(name + "tangential restitution", dot(after.v, along) / v_t,
                     1. - mu * (1. + e) / std::tan(angle), tolerance);
      check_relative(name + "spin", dot(after.w, cross({0., 0., 1.}, along)),
                     2.5 * mu * (1. + e) * v_n / radius, tolerance);
      const Vec3 sideways = cross({0., 0., 1.}, along);
      check_close(name + "nothing sideways",
                  std::abs(dot(after.v, sideways)) / speed +
                      (std::abs(dot(after.w, along)) + std::abs(after.w.z)) * radius / speed,
                  0., 1e-13);
    }
}

/// A sphere that spins against the floor drives itself forwards.
void spin_on_floor()
{
  const double mu = 0.3, e = 0.98, v_n = 1., spin = 2000.;
  Scene s = scene(70e9, 0.33, 2700., mu, e);
  s.spheres[0].v = {0., 0., -v_n};
  s.spheres[0].w = {0., spin, 0.};
  const Sphere after = collide(s, v_n).at(0);
  check_relative("spin on the floor: velocity", after.v.x, mu * (1. + e) * v_n, tolerance);
  check_relative("spin on the floor: spin", after.w.y, spin - 2.5 * mu * (1. + e) * v_n / radius,
                 tolerance);
}

/// Two equal spheres meet head-on along @p normal, spinning about the axis @p turn.
void spinning_pair(const std::string &name, const Vec3 &normal, const Vec3 &turn)
{
  const double mu = 0.3, e = 0.98, v = 0.5, spin = 2000.;
  Scene s = scene(70e9, 0.33, 2700., mu, e);
  s.floor = false;
  s.spheres = {{-radius * normal, v * normal, spin * turn, 2. * radius},
               {radius * normal, -v * normal, {}, 2. * radius}};
  std::vector<Sphere> after = collide(s, 2. * v);
  // The surface of the first drags that of the second along, and both spins decrease by the same
  // amount. The line of the centres turns by a thousandth while they touch.
  const double pair_tolerance = 1e-3;
  const Vec3 kick = mu * (1. + e) * v * cross(turn, normal);
  check_relative(name + "velocity of the first", dot(after[0].v, kick), -dot(kick, kick),
                 pair_tolerance);
  check_relative(name + "velocity of the second", dot(after[1].v, kick), dot(kick, kick),
                 pair_tolerance);
  check_relative(name + "spin of the first", dot(after[0].w, turn),
                 spin - 2.5 * norm(kick) / radius, pair_tolerance);
  check_relative(name + "spin of the second", dot(after[1].w, turn), -2.5 * norm(kick) / radius,
                 pair_tolerance);

  // Opposite spins: the surfaces do not slip, nothing turns.
  s.particle.restitution = 0.5;
  s.particle.friction = 0.4;
  s.spheres[0].w = 100. * turn;
  s.spheres[1].w = -100. * turn;
  after = collide(s, 2. * v);
  check(name + "opposite spins are kept",
        after[0].w == s.spheres[0].w && after[1].w == s.spheres[1].w);
  check(name + "no tangential velocity from opposite spins",
        norm(cross(after[0].v, normal)) == 0. && norm(cross(after[1].v, normal)) == 0.);
  check_relative(name + "restitution", dot(after[1].v - after[0].v, normal), v, 1e-3);
}

/// Oblique impact of two unlike spheres that slide throughout: the impulse of friction, against the
/// slip, is mu (1 + e) times the normal momentum; times radius over inertia it changes each spin.
void unlike_pair()
{
  const double mu = 0.1, e = 0.98, v_n = 1., v_t = 1.;
  Scene s = scene(70e9, 0.33, 2700., mu, e);
  s.floor = false;
  const Vec3 normal = Vec3{2., 3., 6.} / 7., along = Vec3{3., -6., 2.} / 7.,
             axis = cross(normal, along);
  Sphere a = {{}, v_n * normal + v_t * along, {}, 2. * radius}, b = {{}, {}, {}, 0.8 * radius};
  b.x = (a.radius() + b.radius()) * normal;
  s.spheres = {a, b};
  const auto half = [](double x, double y) { return x * y / (x + y); };
  const double mass = half(s.mass(a), s.mass(b)), r = half(a.radius(), b.radius());
  const double duration = Impact(s.particle, s.particle, mass, r, v_n).duration();
  s.time_step = duration / 10000.;
  s.time_end = 1.5 * duration;
  const std::vector<Sphere> after = run(s);
  // They pass each other while they touch, so the line of the centres turns.
  const double pair_tolerance = 0.02, impulse = mu * (1. + e) * mass * v_n;
  check_relative("unlike spheres: velocity along", dot(after[1].v, along), impulse / s.mass(b),
                 pair_tolerance);
  check_relative("unlike spheres: spin of the first", dot(after[0].w, axis),
                 -a.radius() * impulse / s.inertia(a), pair_tolerance);
  check_relative("unlike spheres: spin of the second", dot(after[1].w, axis),
                 -b.radius() * impulse / s.inertia(b), pair_tolerance);
  // The same force acts on both with arms of their radii, whatever the law.
  check_relative("unlike spheres: ratio of the spins",
                 dot(after[0].w, axis) / dot(after[1].w, axis),
                 a.radius() * s.inertia(b) / (b.radius() * s.inertia(a)), 1e-10);
}

} // namespace

EUNOE_MPI_TEST()
{
  oblique("alumina", 380e9, 0.23, 4000.);
  oblique("aluminium alloy", 70e9, 0.33, 2700.);
  spin_on_floor();
  unlike_pair();
  const Vec3 axes[] = {{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}};
  for (unsigned int n = 0; n < 3; ++n)
    for (unsigned int t = 0; t < 3; ++t)
      if (t != n)
        spinning_pair(std::string("pair along ") + "xyz"[n] + ", spin about " + "xyz"[t] + ": ",
                      axes[n], axes[t]);
}
