// Rolling resistance in a head-on impact. It brakes the spin of one body against the other in the
// plane of the contact: opposite spins lose mu_r R_e times the normal impulse, equal spins nothing.
// With a torque in proportion to the speed of rolling the relative spin of two unlike spheres
// decays exponentially with the impulse, and their angular momentum is kept.
// EPSD's dashpot takes the effective inertia of both.

#include "../spheres.h"

using namespace test;

namespace {

const double radius = 0.5e-3, rolling_friction = 0.02, speed = 0.5;

/// Two spheres, or one on the floor, after an elastic impact without friction.
std::vector<Sphere> collide(const std::string &rolling, const Vec3 &normal, const Vec3 &spin_0,
                            const Vec3 &spin_1, bool floor)
{
  Scene s;
  s.rolling = rolling;
  s.particle.rolling_friction = s.wall.rolling_friction = rolling_friction;
  meet(s, floor, radius, speed, normal, {{spin_0, spin_1}});
  return run(s);
}

void check_pair(const std::string &name, const Vec3 &normal, const Vec3 &turn)
{
  const double w = 1000.;
  // m_e = m/2, R_e = R/2 and a relative speed of twice the speed of each.
  const double lost = rolling_friction * 0.5 * radius * 2. * speed / (0.4 * radius * radius);
  std::vector<Sphere> after = collide("constant", normal, w * turn, -w * turn, false);
  check_relative(name + "opposite spins, first", dot(after[0].w, turn), w - lost, 1e-4);
  check_relative(name + "opposite spins, second", dot(after[1].w, turn), -w + lost, 1e-4);
  for (const std::string rolling : {"constant", "epsd"}) {
    after = collide(rolling, normal, w * turn, w * turn, false);
    check(name + "equal spins, " + rolling, after[0].w == w * turn && after[1].w == w * turn);
  }
}

void check_viscous()
{
  Scene s;
  s.rolling = "viscous";
  const Vec3 normal = {0.6, 0., -0.8}, turn = {0., 1., 0.};
  Sphere a = {{}, speed * normal, 1000. * turn, 2. * radius};
  Sphere b = {{}, -speed * normal, -300. * turn, 1.2 * radius};
  a.x = -a.radius() * normal;
  b.x = b.radius() * normal;
  const auto half = [](double x, double y) { return x * y / (x + y); };
  const double r = half(a.radius(), b.radius()), m = half(s.mass(a), s.mass(b));
  const double inertia = half(s.inertia(a), s.inertia(b)), impulse = 2. * m * 2. * speed;
  const double exponent = 0.7;
  s.particle.rolling_friction = exponent * inertia / (r * r * impulse);
  s.spheres = {a, b};
  const double duration = Impact(s.particle, s.particle, m, r, 2. * speed).duration();
  s.time_step = duration / 5000.;
  s.time_end = 1.5 * duration;
  const std::vector<Sphere> after = run(s);
  check_relative("viscous, unlike spheres: relative spin", dot(after[0].w - after[1].w, turn),
                 1300. * std::exp(-exponent), 1e-4);
  const auto momentum = [&s, &turn](const Sphere &one, const Sphere &other) {
    return s.inertia(one) * dot(one.w, turn) + s.inertia(other) * dot(other.w, turn);
  };
  check_relative("viscous, unlike spheres: angular momentum", momentum(after[0], after[1]),
                 momentum(a, b), 1e-12);
}

/// One short step of two unlike spheres that overlap and turn: EPSD's spring is not loaded yet, its
/// dashpot is 2 eta_r sqrt(I_r k_r) with k_r = 2.25 k_n (mu_r R_e)^2, where I_r is the effective
/// inertia of 7/5 m R^2 of each.
void check_epsd_dashpot()
{
  Scene s;
  s.rolling = "epsd";
  s.particle.rolling_friction = 0.02;
  s.particle.rolling_viscous_damping = 0.3;
  const double overlap = 1e-6, w = 1300.;
  Sphere a = {{}, {}, {0., 1000., 0.}, 2. * radius}, b = {{}, {}, {0., -300., 0.}, 1.2 * radius};
  b.x.x = a.radius() + b.radius() - overlap;
  s.spheres = {a, b};
  s.time_step = s.time_end = 1e-9;
  const auto half = [](double x, double y) { return x * y / (x + y); };
  const double r = half(a.radius(), b.radius());
  const double normal = Impact(s.particle, s.particle, 1., r, 0.).stiffness * std::sqrt(overlap);
  const double arm = s.particle.rolling_friction * r;
  const double torque = 2. * s.particle.rolling_viscous_damping *
                        std::sqrt(3.5 * half(s.inertia(a), s.inertia(b)) * 2.25 * normal) * arm * w;
  const std::vector<Sphere> after = run(s);
  check_relative("epsd, unlike spheres: dashpot on the first", after[0].w.y - a.w.y,
                 -torque * s.time_step / s.inertia(a), 1e-4);
  check_relative("epsd, unlike spheres: dashpot on the second", after[1].w.y - b.w.y,
                 torque * s.time_step / s.inertia(b), 1e-4);
}

void check_floor()
{
  const double w = 2000.;
  const double lost = rolling_friction * radius * 2. * speed / (0.4 * radius * radius);
  const Vec3 down = {0., 0., -1.}, turn = {0.6, -0.8, 0.};
  check_relative("floor: roll", dot(collide("constant", down, w * turn, {}, true)[0].w, turn),
                 w - lost, 1e-4);
}

} // namespace

EUNOE_MPI_TEST()
{
  const Vec3 axes[] = {{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}};
  for (unsigned int n = 0; n < 3; ++n)
    for (unsigned int t = 0; t < 3; ++t)
      if (t != n)
        check_pair(std::string("pair along ") + "xyz"[n] + ", spin about " + "xyz"[t] + ": ",
                   axes[n], axes[t]);
  check_viscous();
  check_epsd_dashpot();
  check_floor();
}
