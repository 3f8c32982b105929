// The weight of a grain that sleeps in the air: none while it sleeps; from the step on in which it
// wakes; and from the next step on if it wakes between two steps, as it counts as being in balance
// until then. What comes has its weight at once.
// Reference: a fall from rest in steps, of which velocity Verlet has done half of the next one.

#include "../spheres.h"

using namespace test;

namespace {

constexpr double dt = 1e-6, gravity = -9.81;

/// No force, but at some moment the grains are told that it changes, which wakes them.
class Nudge : public Load
{
public:
  void add(ParticleArrays &, double) const override {}
  bool changes(double begin, double end) const override
  {
    constexpr double moment = 75. * dt;
    return begin <= moment && moment < end;
  }

  static bool acts;
};
bool Nudge::acts = false;

class NudgeSection : public LoadSection
{
public:
  std::unique_ptr<Load> make(const PhysicalProperties &) const override
  {
    return Nudge::acts ? std::make_unique<Nudge>() : nullptr;
  }
};

const LoadRegistry::Registration registration(loads(), "nudge",
                                              [] { return std::make_unique<NudgeSection>(); });

/// A grain that counts as at rest although it falls, so that it sleeps from the look at step 50 on.
/// The next look is at step 100.
Scene hanging(const std::string &integration)
{
  Scene scene;
  scene.integration = integration;
  scene.gravity.z = gravity;
  scene.time_step = dt;
  scene.time_end = 125. * dt;
  scene.spheres = {Sphere()};
  scene.more = "subsection model parameters\n subsection adaptive sparse contacts\n" +
               Scene::entry("enable adaptive sparse contacts", "true") +
               Scene::entry("check frequency", "50") + Scene::entry("rest speed", 1e3) +
               Scene::entry("rest time", 20. * dt) + Scene::entry("rest displacement", 1e3) +
               " end\nend\n";
  return scene;
}

/// Vertical velocity of a particle, by its place in the order of ids (m/s).
double speed(Simulation &simulation, const std::size_t number)
{
  return particle_table(simulation).at(number)[c_vz];
}

/// A grain comes so near that the two are neighbours, but do not touch.
void insert_beside(Simulation &simulation, const Scene &scene)
{
  const Sphere &first = scene.spheres[0];
  NewParticle guest;
  guest.id = simulation.take_ids(1);
  guest.radius = first.radius();
  guest.mass = scene.mass(first);
  guest.position.x = 1.2 * first.diameter;
  Delivery delivery;
  delivery.particles.push_back(guest);
  simulation.insert_and_remove(delivery, {});
}

/// @param half what the integrator has done of the next step
void fall(const std::string &integration, const double half)
{
  const Scene scene = hanging(integration);
  Nudge::acts = true;
  Case nudged(scene.text());
  nudged.run([&](Simulation &simulation) {
    if (simulation.step_number() == 60)
      check(integration + ": none in sleep", speed(simulation, 0) == 0.);
    if (simulation.step_number() == 99)
      check(integration + ": nor later", speed(simulation, 0) == 0.);
    if (simulation.step_number() == 120)
      check_relative(integration + ": woken in a step", speed(simulation, 0),
                     (20. + half) * dt * gravity, 1e-12);
  });
  Nudge::acts = false;
  Case joined(scene.text());
  joined.run([&](Simulation &simulation) {
    if (simulation.step_number() == 70)
      insert_beside(simulation, scene);
    if (simulation.step_number() == 90) {
      check_relative(integration + ": woken between steps", speed(simulation, 0),
                     (19. + half) * dt * gravity, 1e-12);
      check_relative(integration + ": come between steps", speed(simulation, 1), 20. * dt * gravity,
                     1e-12);
    }
  });
}

} // namespace

EUNOE_MPI_TEST()
{
  fall("velocity_verlet", 0.5);
  fall("explicit_euler", 0.);
  fall("symplectic_euler", 0.);
}
