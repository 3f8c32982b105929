// Sleepers must respond in time to disturbances: a plate that reaches a grain which has drifted
// since the search, a plate that starts to move between two checks of who sleeps, and the loss of a
// neighbour. References: collisions with a wall that moves (a grain at rest leaves an elastic one
// with twice the speed of the wall), free fall, and the same case without sleep.

#include <eunoe/processes/loose_powder.h>

#include "../spheres.h"

using namespace test;

namespace {

/// Speed below which a grain counts as at rest (m/s). It may go far meanwhile, so that a sleeper
/// has drifted since the search.
constexpr double rest_speed = 1e-2, rest_displacement = 1e3;

std::string sparse(bool enabled, double rest_time, double displacement = rest_displacement)
{
  return "subsection model parameters\n subsection adaptive sparse contacts\n" +
         Scene::entry("enable adaptive sparse contacts", enabled ? "true" : "false") +
         Scene::entry("rest speed", rest_speed) + Scene::entry("rest time", rest_time) +
         Scene::entry("rest displacement", displacement) + " end\nend\n";
}

/// A horizontal plate that rises with @p speed from a time on.
std::string plate(double height, double start, double speed)
{
  return "subsection solid objects\n subsection solid surfaces\n  set number of solids = 1\n"
         "  subsection solid object 0\n   subsection mesh\n    set type = shape\n"
         "    set grid type = plane\n    set grid arguments = -6e-3, -6e-3, " +
         Scene::number(height) +
         " : 12e-3, 0, 0 : 0, 12e-3, 0\n   end\n"
         "   subsection translational velocity\n    set Function expression = 0; 0; if(t > " +
         Scene::number(start) + ", " + Scene::number(speed) + ", 0)\n   end\n  end\n end\nend\n";
}

std::size_t n_asleep(Simulation &simulation)
{
  const ParticleArrays &p = simulation.get_system().particles;
  unsigned long long n = p.n_owned - p.n_awake();
  MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, simulation.communicator());
  return n;
}

/// A grain drifts towards a plate by 0.4 of the skin and falls asleep 0.3 mm above it; the two
/// touch before the displacement of the plate alone would make another search due.
Scene drifting(const std::string &integration, bool sleep)
{
  Scene scene;
  scene.integration = integration;
  scene.time_step = 1e-6;
  scene.time_end = 0.05;
  Sphere grain;
  // Beyond the skin of 0.5 mm, so that the first search does not list the pair.
  grain.x = {0.1e-3, 0.2e-3, 0.505e-3 + grain.radius()};
  grain.v.z = -7.5e-3;
  scene.spheres = {grain};
  scene.more = "subsection model parameters\n subsection contact detection\n"
               "  set neighborhood threshold = 1.5\n end\nend\n" +
               sparse(sleep, 0.025) + plate(0., 0.035, 0.1);
  return scene;
}

/// The row of the particle with the highest id, which may be on any rank.
std::vector<double> last_of(Simulation &simulation)
{
  return particle_table(simulation).back();
}

void test_drift(const std::string &integration)
{
  const std::string name = integration + ": ";
  for (const bool sleep : {false, true}) {
    Case test_case(drifting(integration, sleep).text());
    std::size_t asleep = 0;
    test_case.run([&](Simulation &simulation) {
      if (simulation.step_number() == 34000)
        asleep = n_asleep(simulation);
    });
    check(name + "it " + (sleep ? "sleeps" : "is awake"), asleep == (sleep ? 1 : 0));
    // A sleeper has lost its drift, with which a grain that is awake meets the plate. With a
    // hundred steps a contact the error is some 1e-4 for velocity Verlet and some 1e-2 for Euler.
    check_relative(name + "it leaves the plate, " + (sleep ? "after sleep" : "without sleep"),
                   last_of(*test_case)[c_vz], sleep ? 0.2 : 0.2 + 7.5e-3,
                   integration == "velocity_verlet" ? 1e-3 : 3e-2);
  }
}

/// A grain that moves more slowly than the rest speed, but goes on: it creeps, and so is awake.
/// With a period in its direction it crosses the end of the box, where its coordinate jumps.
void test_creep()
{
  // In the rest time of 25 ms it goes a hundredth of its diameter.
  const double speed = 4e-4;
  for (const double displacement : {0.009, 0.011}) {
    Scene scene;
    scene.time_step = 1e-5;
    scene.time_end = 0.06;
    Sphere grain;
    grain.x.x = 10e-3 - 0.5 * speed * scene.time_end;
    grain.v.x = speed;
    scene.spheres = {grain};
    scene.more = sparse(true, 0.025, displacement) +
                 "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
                 " subsection boundary condition 0\n  set type = periodic\n"
                 "  set periodic id 0 = 0\n  set periodic id 1 = 1\n"
                 "  set periodic direction = 0\n end\nend\n";
    Case test_case(scene.text());
    std::size_t asleep = 0;
    test_case.run([&](Simulation &simulation) { asleep = std::max(asleep, n_asleep(simulation)); });
    const bool sleeps = displacement > 0.01;
    check(std::string("creep within ") + (sleeps ? "a larger" : "a smaller") +
              " displacement: it " + (sleeps ? "sleeps" : "is awake"),
          asleep == (sleeps ? 1 : 0));
  }
}

/// Whether the particle with an id sleeps, on whatever rank it is.
bool sleeps(Simulation &simulation, ParticleId id)
{
  const ParticleArrays &p = simulation.get_system().particles;
  int found = 0;
  for (std::size_t row = 0; row < p.n_owned; ++row)
    if (p.id[row] == id && !p.is_awake(row))
      found = 1;
  MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MAX, simulation.communicator());
  return found != 0;
}

/// A particle that is inserted or taken out wakes those that touch it, and nobody else.
void test_insertion()
{
  constexpr unsigned long long insertion = 20000, removal = 40000;
  Scene scene;
  scene.particle.restitution = scene.wall.restitution = 0.3;
  scene.gravity.z = -9.81;
  scene.time_step = 2e-6;
  scene.time_end = 0.09;
  scene.floor = true;
  Sphere here = resting_sphere(scene), there = here;
  there.x.x += 5e-3;
  scene.spheres = {here, there};
  scene.more = sparse(true, 0.01);
  Case test_case(scene.text());
  test_case.run([&](Simulation &simulation) {
    const unsigned long long step = simulation.step_number();
    if (step == insertion || step == removal)
      check("two grains: both sleep", sleeps(simulation, 1) && sleeps(simulation, 2));
    if (step == insertion)
      simulation.insert_and_remove(loose_powder(simulation, 0, 1, Vec3(),
                                                [&](auto...) {
                                                  return here.x + Vec3{0., 0., here.diameter};
                                                }),
                                   {});
    if (step == removal) {
      const ParticleArrays &p = simulation.complete_step();
      std::vector<std::size_t> above;
      for (std::size_t row = 0; row < p.n_owned; ++row)
        if (p.id[row] == 3)
          above.push_back(row);
      simulation.insert_and_remove({}, above);
    }
    if (step == insertion || step == removal)
      check(std::string("one more ") + (step == removal ? "goes" : "comes") +
                ": that which touches it wakes, the other sleeps on",
            !sleeps(simulation, 1) && sleeps(simulation, 2));
  });
}

/// The same, interrupted while the grain sleeps at its new place.
void test_restart()
{
  const auto result_of = [](const std::string &more) {
    Case test_case(drifting("velocity_verlet", true).text() + more);
    test_case.run();
    return particle_table(*test_case);
  };
  const auto whole = result_of("");
  const std::string every = "subsection restart\n set checkpoint = true\n set frequency = 10000\n";
  const std::string first = "subsection simulation control\n set time end = 0.034\nend\n";
  result_of(every + "end\n" + first);
  check("the same bits after a restart", result_of(every + " set restart = true\nend\n") == whole);
}

/// A grain rests on a plate that starts to rise 13 steps after a check of who sleeps.
void test_start()
{
  const double speed = 0.2, start = 0.05 + 13.5e-6;
  double fastest[2] = {0., 0.};
  for (const int sleep : {0, 1}) {
    Scene scene;
    scene.particle.restitution = scene.wall.restitution = 0.3;
    scene.gravity.z = -9.81;
    scene.time_step = 1e-6;
    scene.time_end = start + 5e-4;
    scene.spheres = {resting_sphere(scene)};
    scene.more = sparse(sleep == 1, 0.01) + plate(0., start, speed);
    Case test_case(scene.text());
    test_case.run([&](Simulation &simulation) {
      const unsigned long long step = simulation.step_number();
      if (step == 50000)
        check("the plate starts: asleep", n_asleep(simulation) == static_cast<unsigned int>(sleep));
      if (step > 50000)
        fastest[sleep] = std::max(fastest[sleep], last_of(simulation)[c_vz]);
    });
  }
  check("the plate starts: it throws the grain", fastest[0] > speed);
  // In both cases the grain is at rest when it is hit; they differ by the last motion of its
  // settling.
  check_close("the plate starts: as it does without sleep", fastest[1], fastest[0], 1e-5);
}

/// The lower one of two grains on top of each other is removed, and the upper one falls.
void test_support()
{
  const double gravity = 9.81;
  Scene scene;
  scene.particle.restitution = scene.wall.restitution = 0.3;
  scene.gravity.z = -gravity;
  scene.time_step = 2e-6;
  scene.time_end = 0.055;
  Sphere lower = resting_sphere(scene), upper = lower;
  upper.x.z += upper.diameter;
  scene.spheres = {lower, upper};
  scene.floor = true;
  scene.more =
      sparse(true, 0.01) + "subsection model parameters\n set lost particles = ignore\nend\n";
  Case test_case(scene.text());
  double before = 0., since = -1.;
  test_case.run([&](Simulation &simulation) {
    const unsigned long long step = simulation.step_number();
    if (step < 25000)
      return;
    if (step == 25000) {
      check("the support goes: both sleep", n_asleep(simulation) == 2);
      before = last_of(simulation)[c_z];
      ParticleArrays &p = simulation.changeable_particles();
      for (std::size_t row = 0; row < p.n_owned; ++row)
        if (p.id[row] == 1)
          p.velocity[row].x = 8000.; // beyond the wall in a step
    }
    const Tally lost = simulation.get_ledger().lost.global(simulation.communicator());
    if (since < 0. && lost.number > 0)
      since = simulation.time();
  });
  check("the support goes: it is gone", since > 0. && particle_table(*test_case).size() == 1);
  const double time = scene.time_end - since;
  // The fall starts from rest; in the step in which the lower grain goes, it may still exert a
  // force.
  check_close("the support goes: free fall", last_of(*test_case)[c_z] - before,
              -0.5 * gravity * time * time, gravity * time * scene.time_step);
}

} // namespace

EUNOE_MPI_TEST()
{
  for (const std::string integration : {"velocity_verlet", "explicit_euler", "symplectic_euler"})
    test_drift(integration);
  test_creep();
  test_insertion();
  test_restart();
  test_start();
  test_support();
}
