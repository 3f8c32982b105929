#ifndef eunoe_tests_spheres_h
#define eunoe_tests_spheres_h

// A few spheres in an empty box, perhaps over a floor: the scene of the tests of dynamics, and the
// analytic solution of a normal impact.

#include "tests.h"

#include <array>
#include <vector>

namespace test {

struct Sphere
{
  Vec3 x, v, w;
  double diameter = 1e-3;

  double radius() const { return 0.5 * diameter; }
};

/// A case of a few spheres, as an input text. SI units.
struct Scene
{
  double time_step = 1e-6, time_end = 1e-3;
  std::vector<Sphere> spheres;
  Material particle, wall;
  double density = 1000.;
  Vec3 gravity;
  /// Half the width of the box, whose walls should not be met; 0: ten times the largest diameter.
  double half_width = 0.;
  /// Whether the plane z = 0 is a wall.
  bool floor = false;
  bool dmt = false, limit_force = false;
  std::string rolling = "none";
  std::string integration = "velocity_verlet";
  /// Entries added after all others.
  std::string more;

  Scene()
  {
    for (Material *m : {&particle, &wall}) {
      *m = Material();
      m->young_modulus = 1e7;
      m->restitution = 1.;
      m->friction = 0.;
    }
  }

  double largest_diameter() const
  {
    double largest = 0.;
    for (const Sphere &s : spheres)
      largest = std::max(largest, s.diameter);
    return largest;
  }
  double mass(const Sphere &s) const { return sphere_mass(s.radius(), density); }
  double inertia(const Sphere &s) const { return 0.4 * mass(s) * s.radius() * s.radius(); }

  std::string text() const
  {
    const double half = half_width > 0. ? half_width : 10. * largest_diameter();
    const std::string lower = number(-half), upper = number(half);
    return "subsection simulation control\n" + entry("time step", time_step) +
           entry("time end", time_end) + entry("log frequency", "0") +
           entry("output path", "results") + "end\n" + "subsection mesh\n" +
           entry("grid type", "subdivided_hyper_rectangle") +
           entry("grid arguments", "4, 4, 4 : " + lower + "," + lower + "," + lower + " : " +
                                       upper + "," + upper + "," + upper + " : true") +
           "end\nsubsection lagrangian physical properties\n" +
           entry("g", number(gravity.x) + "," + number(gravity.y) + "," + number(gravity.z)) +
           "subsection particle type 0\n" + entry("diameter", largest_diameter()) +
           entry("density particles", density) + material(particle, "particles") + "end\n" +
           material(wall, "wall") + "end\nsubsection model parameters\n" +
           entry("particle particle contact force method", dmt ? "DMT"
                                                           : limit_force
                                                               ? "hertz_mindlin_limit_force"
                                                               : "hertz_mindlin_limit_overlap") +
           entry("particle wall contact force method", dmt ? "DMT" : "nonlinear") +
           entry("rolling resistance torque method", rolling) +
           entry("integration method", integration) + "end\nsubsection insertion info\n" +
           entry("insertion method", "list") + lists() + "end\n" +
           (floor ? "subsection floating walls\n" + entry("number of floating walls", "1") +
                        "subsection wall 0\n" + entry("point on wall", "0,0,0") +
                        entry("normal vector", "0,0,1") + entry("end time", "1e9") + "end\nend\n"
                  : std::string()) +
           more;
  }

  static std::string number(double value)
  {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
  }
  static std::string entry(const std::string &name, const std::string &value)
  {
    return " set " + name + " = " + value + "\n";
  }
  static std::string entry(const std::string &name, double value)
  {
    return entry(name, number(value));
  }
  static std::string material(const Material &m, const std::string &of)
  {
    return entry("young modulus " + of, m.young_modulus) +
           entry("poisson ratio " + of, m.poisson_ratio) +
           entry("restitution coefficient " + of, m.restitution) +
           entry("friction coefficient " + of, m.friction) +
           entry("rolling friction " + of, m.rolling_friction) +
           entry("rolling viscous damping " + of, m.rolling_viscous_damping) +
           entry("surface energy " + of, m.surface_energy) +
           entry("hamaker constant " + of, m.hamaker_constant);
  }

private:
  std::string lists() const
  {
    const std::pair<std::string, Vec3 Sphere::*> vectors[] = {
        {"", &Sphere::x}, {"velocity ", &Sphere::v}, {"omega ", &Sphere::w}};
    std::string text, diameters;
    for (const auto &[name, vector] : vectors)
      for (unsigned int d = 0; d < 3; ++d) {
        std::string values;
        for (const Sphere &s : spheres)
          values += (values.empty() ? "" : ",") + number((s.*vector)[d]);
        text += entry("list " + name + "xyz"[d], values);
      }
    for (const Sphere &s : spheres)
      diameters += (diameters.empty() ? "" : ",") + number(s.diameter);
    return text + entry("list diameters", diameters);
  }
};

/// Spheres whose contacts lose energy in every way.
inline Scene dissipative_scene()
{
  Scene s;
  s.particle.restitution = 0.6;
  s.particle.friction = 0.4;
  s.particle.rolling_friction = 0.1;
  s.rolling = "epsd";
  return s;
}

/// All spheres of one rank, in the order in which they were inserted.
inline std::vector<Sphere> spheres_of(Simulation &simulation)
{
  const ParticleArrays &p = simulation.complete_step();
  std::vector<Sphere> spheres(p.n_owned);
  for (std::size_t k = 0; k < p.n_owned; ++k)
    spheres[p.id[k] - 1] = {p.position[k].vec(), p.velocity[k].vec(), p.spin[k].vec(),
                            2. * p.radius(k)};
  return spheres;
}

/// Runs a scene to its end.
/// @param look called before the first step and after every step
inline std::vector<Sphere> run(const Scene &scene,
                               const std::function<void(Simulation &)> &look = {})
{
  Case one(scene.text());
  one.run(look);
  return spheres_of(*one);
}

/// Normal impact of two bodies with Hertz's force and Tsuji's damping.
///
/// With y = 4/5 x^(5/4) for the overlap x and ds = sqrt(K/m) x^(1/4) dt, the equation of motion is
/// that of the linear oscillator y'' + sqrt(5) D y' + 5/4 y = 0, where D = -beta.
struct Impact
{
  double mass, stiffness; ///< effective mass (kg); elastic force / overlap^(3/2)
  double speed, damping;  ///< speed of approach (m/s); D

  Impact(const Material &a, const Material &b, double mass, double radius, double speed)
      : mass(mass), speed(speed)
  {
    const double young = 1. / ((1. - a.poisson_ratio * a.poisson_ratio) / a.young_modulus +
                               (1. - b.poisson_ratio * b.poisson_ratio) / b.young_modulus);
    stiffness = 4. / 3. * young * std::sqrt(radius);
    const double e = a.restitution + b.restitution > 0.
                         ? 2. * a.restitution * b.restitution / (a.restitution + b.restitution)
                         : 0.;
    damping = e > 0. ? -std::log(e) / std::hypot(std::log(e), M_PI) : 1.;
  }

  /// Largest overlap (m).
  double overlap() const
  {
    const double c = std::sqrt(1. - damping * damping);
    const double y = speed * std::sqrt(mass / stiffness) * 2. / std::sqrt(5.) *
                     std::exp(-damping * (c > 0. ? std::acos(damping) / c : 1.));
    return std::pow(1.25 * y, 0.8);
  }
  /// Largest force (N), without damping.
  double force() const { return stiffness * std::pow(overlap(), 1.5); }
  /// Duration of the contact (s), without damping.
  double duration() const
  {
    return 0.8 * std::sqrt(M_PI) * std::tgamma(0.4) / std::tgamma(0.9) * overlap() / speed;
  }
};

/// Two equal spheres that collide head-on at the origin, or one that hits the floor; the run lasts
/// from first touch until after the impact.
/// @param normal from the first to the second, or to the floor
/// @param spins of both (rad/s)
inline void meet(Scene &s, bool floor, double radius, double speed, const Vec3 &normal,
                 const std::array<Vec3, 2> &spins)
{
  s.floor = floor;
  s.spheres = {{-radius * normal, speed * normal, spins[0], 2. * radius}};
  if (!floor)
    s.spheres.push_back({radius * normal, -speed * normal, spins[1], 2. * radius});
  const double share = floor ? 1. : 0.5;
  const double duration =
      Impact(s.particle, s.wall, share * s.mass(s.spheres[0]), share * radius, speed / share)
          .duration();
  s.time_step = duration / 5000.;
  s.time_end = 1.5 * duration;
}

/// A sphere that rests on the floor under gravity, which may also have a component along the floor.
inline Sphere resting_sphere(const Scene &scene, double diameter = 1e-3)
{
  Sphere s;
  s.diameter = diameter;
  const Impact hertz(scene.particle, scene.wall, scene.mass(s), s.radius(), 0.);
  s.x.z = s.radius() - std::pow(-scene.mass(s) * scene.gravity.z / hertz.stiffness, 2. / 3.);
  return s;
}

} // namespace test

#endif
