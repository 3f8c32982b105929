// The force on the spreader of layers.csv: the mean and the largest of the sums over its contacts,
// at every tenth step at which it is over the plate and none other. Dampers see the velocities
// after a step here, and those within it there, which makes the tolerance.

#include "small_case.h"
#include "tests.h"

#include <map>

using namespace test;

namespace {

constexpr double plate_begin = 0.9e-3, plate_end = plate_begin + plate_length;
constexpr unsigned long long sampling = 10;

struct Force
{
  double sum = 0., most = 0.;
  unsigned int n = 0;
};

} // namespace

EUNOE_MPI_TEST()
{
  Case run(small_spreading("results_spreader_force", ""));
  std::map<std::string, Force> forces; // by spreader; each of the two makes one pass
  run.run([&](Simulation &simulation) {
    const std::vector<Solid> &solids = simulation.get_solids();
    for (std::size_t s = 0; s < solids.size(); ++s) {
      if (solids[s].name.rfind("spreader ", 0) != 0)
        continue;
      const double x = solids[s].state.centre.x;
      if (simulation.step_number() % sampling != 0 || x < plate_begin || x >= plate_end)
        continue;
      Vec3 force;
      for (const ContactForce &contact : simulation.contact_forces())
        if (contact.solid == static_cast<int>(s))
          force = force + contact.force();
      Force &of_pass = forces[solids[s].name];
      of_pass.sum += norm(force);
      of_pass.most = std::max(of_pass.most, norm(force));
      ++of_pass.n;
    }
  });
  unsigned int n_compared = 0;
  for (const Measurement &m : run->measurements()) {
    if (m.observable.rfind("spreader_force", 0) != 0)
      continue;
    const Force &force = forces["spreader " + std::to_string(m.index)];
    const std::string of_layer = " of layer " + std::to_string(m.index);
    if (m.observable == "spreader_force_mean")
      check_relative("mean" + of_layer, m.value, force.sum / force.n, 0.05);
    else
      check_relative("most" + of_layer, m.value, force.most, 0.05);
    ++n_compared;
  }
  check("both of two layers", n_compared == 4 && forces.size() == 2);
}
