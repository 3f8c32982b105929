#ifndef eunoe_tests_elastic_box_h
#define eunoe_tests_elastic_box_h

// A gas of a thousand spheres in a closed box without gravity and friction. They fill a third of
// the volume, so that they collide often. Elastic spheres keep their energy; with damping it never
// grows.

#include "../spheres.h"

#include <random>

namespace test {

class ElasticBox
{
public:
  /// @param time_step (s); a typical contact takes 75e-6 s
  ElasticBox(double restitution, double time_step)
  {
    scene.particle.restitution = scene.wall.restitution = restitution;
    scene.half_width = half;
    scene.time_step = time_step;
    // The numbers of the generator are the same with every standard library, those of the
    // distributions are not.
    std::mt19937 generator(3);
    const auto random = [&] { return generator() / 4294967295. - 0.5; };
    for (int k = 0; k < n * n * n; ++k) {
      const double pitch = 2. * half / n;
      Sphere s;
      s.x = {pitch * (k % n + 0.5) - half, pitch * (k / n % n + 0.5) - half,
             pitch * (k / (n * n) + 0.5) - half};
      s.v = {random(), random(), random()};
      scene.spheres.push_back(s);
    }
  }

  /// Results of a run. Energies are relative to that at the start.
  struct Outcome
  {
    double drift = 0.;      ///< largest change
    double growth = 0.;     ///< largest growth between two looks
    double left = 1.;       ///< at the end
    double collisions = 0.; ///< a lower bound of their number
  };

  /// @param steps_between_looks at the energy
  Outcome run(unsigned int steps, unsigned int steps_between_looks)
  {
    scene.time_end = (steps + 0.5) * scene.time_step;
    Outcome outcome;
    const double start = energy(scene.spheres);
    double last = start;
    std::vector<Vec3> velocity(scene.spheres.size());
    std::vector<char> touches(scene.spheres.size(), 0);
    unsigned long starts = 0;
    Case gas(scene.text());
    gas.run([&](Simulation &simulation) {
      const ParticleArrays &p = simulation.complete_step();
      // Without loads the velocity of a sphere changes only while it touches something. A collision
      // of two spheres is a start for both, one with a wall for one; collisions of a sphere without
      // a step between them count as one. So half the number of starts is a lower bound.
      for (std::size_t k = 0; k < p.n_owned; ++k) {
        const std::size_t who = p.id[k] - 1;
        const Vec3 v = p.velocity[k].vec();
        const bool now = simulation.step_number() > 0 && !(v == velocity[who]);
        starts += now && !touches[who];
        touches[who] = now;
        velocity[who] = v;
      }
      if (simulation.step_number() % steps_between_looks != 0)
        return;
      const double now = energy(spheres_of(simulation));
      outcome.drift = std::max(outcome.drift, std::abs(now - start) / start);
      outcome.growth = std::max(outcome.growth, (now - last) / start);
      outcome.left = now / start;
      last = now;
    });
    outcome.collisions = 0.5 * static_cast<double>(starts);
    return outcome;
  }

private:
  /// Kinetic and elastic energy (J), of all pairs and walls by Hertz's formula.
  double energy(const std::vector<Sphere> &spheres) const
  {
    const double poisson = scene.particle.poisson_ratio;
    const double young = 0.5 * scene.particle.young_modulus / (1. - poisson * poisson);
    const auto stored = [&](double overlap, double radius) {
      return overlap > 0. ? 8. / 15. * young * std::sqrt(radius) * std::pow(overlap, 2.5) : 0.;
    };
    double sum = 0.;
    for (std::size_t k = 0; k < spheres.size(); ++k) {
      const Sphere &s = spheres[k];
      const double radius = s.radius();
      sum += 0.5 * scene.mass(s) * norm_square(s.v);
      for (unsigned int d = 0; d < 3; ++d)
        sum += stored(std::abs(s.x[d]) + radius - half, radius);
      for (std::size_t l = 0; l < k; ++l) {
        const Vec3 apart = s.x - spheres[l].x;
        if (norm_square(apart) < 4. * radius * radius)
          sum += stored(2. * radius - norm(apart), 0.5 * radius);
      }
    }
    return sum;
  }

  static constexpr int n = 10;
  static constexpr double half = 5.7e-3;
  Scene scene;
};

} // namespace test

#endif
