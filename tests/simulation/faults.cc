// Faults of particles: which are found, the message, and the reaction, on any number of ranks.

#include <eunoe/checkpoint/checkpoint_file.h>

#include "../tests.h"

#include <fstream>
#include <limits>

using namespace test;

namespace {

/// Three spheres of 1 mm in a box of 20 mm; the first has the given velocity.
std::string input(const std::string &velocity, const std::string &more = "")
{
  return box_input(1e-5, 2e-3,
                   "subsection insertion info\n set insertion method = list\n"
                   " set list x = 0, -4e-3, 4e-3\n set list y = 0, 4e-3, -4e-3\n"
                   " set list z = 5e-3, 5e-3, 5e-3\n"
                   " set list diameters = 1e-3, 1e-3, 1e-3\n set list velocity z = " +
                       velocity + ", 0, 0\nend\n" + more);
}

std::string model(const std::string &entries)
{
  return "subsection model parameters\n" + entries + "\nend\n";
}

/// Overlaps are looked at when contacts are searched for: here as soon as something moves.
const std::string at_each_step = "\n subsection contact detection\n"
                                 "  set dynamic contact search size coefficient = 1e-3\n end";

std::string failure(const std::string &text, const std::function<void(Simulation &)> &look = {})
{
  Case test_case(text);
  try {
    test_case.run(look);
  } catch (const UserError &error) {
    return error.what();
  }
  return "nothing";
}

void expect(const std::string &name, const std::string &message,
            const std::vector<std::string> &parts)
{
  for (const std::string &part : parts)
    check(name, message.find(part) != std::string::npos, "got '" + message + "'");
}

/// The checkpoint of the fault holds the state that the message names, and earlier checkpoints are
/// kept: the run continues from them to the same fault, or past it where that is allowed.
void examine_checkpoints()
{
  const auto text = [](const std::string &overlap, const std::string &restart) {
    return input("-12", model(" set excessive overlap = stop\n set largest overlap = " + overlap +
                              at_each_step) +
                            "subsection restart\n set checkpoint = true\n set frequency = 50\n"
                            " set restart = " +
                            restart + "\nend\n");
  };
  const std::string message = failure(text("0.05", "false"));
  expect("fault", message, {"(step ", " The state is in results/restart_fault.checkpoint."});
  const unsigned long long step =
      std::strtoull(message.substr(message.find("(step ") + 6).c_str(), nullptr, 10);
  check("the fault comes after checkpoints", step > 100 && step < 150, std::to_string(step));

  const Checkpoint fault("results/restart_fault.checkpoint", MPI_COMM_WORLD);
  check("step of the fault", fault.head.at("clock").at("step") == step);
  const Rows rows = fault.rows("particles");
  std::vector<std::vector<double>> mine;
  constexpr unsigned int place = 7; // of the position in a row, after the constant values
  for (std::size_t row = 0; row < rows.size(); ++row)
    mine.push_back({rows[row][0], rows[row][place], rows[row][place + 1], rows[row][place + 2]});
  const auto all = of_all_ranks(MPI_COMM_WORLD, mine);
  unsigned int n_named = 0;
  for (const std::vector<double> &one : all) {
    const std::string name = "particle " + format(one[0]) + " at (" + format(one[1]) + ", " +
                             format(one[2]) + ", " + format(one[3]) + ") m";
    n_named += message.find(name) != std::string::npos ? 1 : 0;
  }
  check("state at the fault", all.size() == 3 && n_named == 1);

  std::ifstream index("results/restart.latest");
  std::string newest;
  std::getline(index, newest);
  check("earlier checkpoints", newest == "restart_000000000100.checkpoint", newest);
  check("the same fault again", failure(text("0.05", "true")) == message);
  Case past(text("0", "true"));
  past.run();
  const auto continued = particle_table(*past);
  Case alone(text("0", "false"));
  alone.run();
  check("past the fault", continued == particle_table(*alone) && continued.size() == 3);
}

/// Batches of four that leave the box at once through its wall. Searches come only every 50 steps,
/// so the loss is found when the next batch is inserted, every ten steps.
std::string batches(const std::string &action)
{
  return box_input(
      1e-5, 2e-3,
      "subsection lagrangian physical properties\n subsection particle type 0\n"
      "  set diameter = 1e-3\n  set number of particles = 12\n end\nend\n"
      "subsection insertion info\n"
      " set inserted number of particles at each time step = 4\n"
      " set insertion frequency = 10\n set initial velocity = 0, 0, -3000\n"
      " set insertion box points coordinates = -9e-3, -9e-3, -9e-3 : 9e-3, 9e-3, 9e-3\n"
      " set insertion distance threshold = 4\nend\n" +
          model(" set lost particles = " + action +
                "\n subsection contact detection\n  set contact detection method = constant\n"
                "  set frequency = 50\n end"));
}

void test_insertion()
{
  expect("lost when others come", failure(batches("stop")),
         {"At t = 0.0001 s (step 10), particle 1 at (", "3 more have gone wrong.",
          "has left the mesh, though not through an outlet.", "fault.checkpoint"});
  for (const std::string action : {"remove", "ignore"}) {
    Case test_case(batches(action));
    std::vector<std::uint64_t> lost;
    test_case.run([&](Simulation &simulation) {
      const unsigned long long step = simulation.step_number();
      if (step == 9 || step == 10 || step == 20 || step == 50)
        lost.push_back(simulation.get_ledger().lost.global(simulation.communicator()).number);
    });
    check(action + " when others come", lost == std::vector<std::uint64_t>({0, 4, 8, 12}));
    check(action + ": none is left", particle_table(*test_case).empty());
  }
}

/// Inserts a particle with an id of more than 31 bits at step 10.
void insert_late(Simulation &simulation, const Vec3 &velocity)
{
  simulation.take_ids((1u << 31) + 5 - simulation.particle_ids().next());
  Delivery delivery;
  NewParticle guest;
  guest.id = simulation.take_ids(1);
  guest.radius = 0.5e-3;
  guest.mass = sphere_mass(guest.radius, 1000.);
  guest.position = {0., 0., -5e-3};
  guest.velocity = velocity;
  if (is_first_rank())
    delivery.particles.push_back(guest);
  simulation.insert_and_remove(delivery, {});
}

void test_large_ids()
{
  const auto loses = [](double speed_of_second) {
    return [speed_of_second](Simulation &simulation) {
      if (simulation.step_number() != 10)
        return;
      insert_late(simulation, {0., 0., -3000.});
      ParticleArrays &p = simulation.changeable_particles();
      for (std::size_t row = 0; row < p.n_owned; ++row)
        if (p.id[row] == 2)
          p.velocity[row].z = speed_of_second;
    };
  };
  expect("a large id", failure(input("0"), loses(0.)), {"particle 2147483653 at (0, 0, -"});
  expect("the smallest id is named", failure(input("0"), loses(-3000.)),
         {"particle 2 at (", "1 more have gone wrong."});

  Case test_case(batches("remove"));
  std::string message;
  try {
    test_case.run([](Simulation &simulation) {
      if (simulation.step_number() == 15)
        simulation.take_ids(ParticleIds::last - simulation.particle_ids().next() - 2);
    });
  } catch (const UserError &error) {
    message = error.what();
  }
  expect("no ids are left", message,
         {"4 particles are to be inserted, but of the 4294967294 ids",
          "only 3 are left. Nothing was inserted,"});
  check("nothing was inserted",
        test_case->get_ledger().inserted.global(test_case->communicator()).number == 8);
}

} // namespace

EUNOE_MPI_TEST()
{
  expect("through the wall", failure(input("-3000")),
         {"particle 1 at (0, 0, -", "with a velocity of (0, 0, -3000) m/s, which touched nothing,",
          "has left the mesh, though not through an outlet.", "fault.checkpoint"});
  expect("deep in the wall",
         failure(input("-12", model(" set excessive overlap = stop\n set largest overlap = 0.05" +
                                    at_each_step))),
         {"particle 1", "overlaps '", "largest overlap"});
  expect("which need not stop it",
         failure(input("-12", model(" set largest overlap = 0.05" + at_each_step))), {"nothing"});
  expect("any overlap is allowed", failure(input("-12", model(" set largest overlap = 0"))),
         {"nothing"});
  const auto poison = [](Simulation &simulation) {
    if (simulation.step_number() != 10)
      return;
    ParticleArrays &p = simulation.changeable_particles();
    for (std::size_t row = 0; row < p.n_owned; ++row)
      if (p.id[row] == 2)
        p.velocity[row].y = std::numeric_limits<double>::quiet_NaN();
  };
  expect("no number", failure(input("0"), poison), {"particle 2", "is not a number any more."});
  expect("searched too rarely",
         failure(input("-5", model(" subsection contact detection\n"
                                   "  set contact detection method = constant\n"
                                   "  set frequency = 50\n  set neighborhood threshold = 1.1\n"
                                   " end"))),
         {"particle 1", "without a search for contacts, and only"});
  for (const std::string action : {"remove", "ignore"}) {
    Case test_case(input("-3000", model(" set lost particles = " + action)));
    test_case.run();
    const Tally lost = test_case->get_ledger().lost.global(test_case->communicator());
    check(action, particle_table(*test_case).size() == 2 && lost.number == 1 &&
                      lost.mass.value() == sphere_mass(0.5e-3, 1000.));
  }
  examine_checkpoints();
  test_insertion();
  test_large_ids();
}
