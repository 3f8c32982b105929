// `neighborhood threshold = auto`: in powder that falls fast and rebounds the skin changes, at the
// same steps and with the same bits on any number of ranks, and no contact is missed. With given
// skins, wide or narrow, the motion is the same but for rounding, as forces are summed in other
// orders.

#include <deal.II/base/mpi.h>

#include "../on_one_rank.h"
#include "touching.h"

using namespace test;

namespace {

constexpr double depth = 4e-3;

std::string input(const std::string &threshold, const std::string &end,
                  const std::string &balancing = "")
{
  return "subsection simulation control\n set time step = 4e-6\n set time end = " + end + R"(
      set log frequency = 0
      set output path = results
    end
    subsection mesh
      set grid type = subdivided_hyper_rectangle
      set grid arguments = 5, 4, 2 : 0, 0, 0 : 10e-3, 8e-3, 4e-3 : true
      set initial refinement = 0
    end
    subsection DEM boundary conditions
      set number of boundary conditions = 1
      subsection boundary condition 0
        set type = periodic
        set periodic id 0 = 4
        set periodic id 1 = 5
        set periodic direction = 2
      end
    end
    subsection lagrangian physical properties
      set g = 0, -9.81, 0
      subsection particle type 0
        set average diameter = 0.7e-3
        set number of particles = 200
        set density particles = 2000
        set restitution coefficient particles = 0.9
        set friction coefficient particles = 0.2
      end
      set restitution coefficient wall = 0.9
    end
    subsection insertion info
      set insertion box points coordinates = 0, 1e-3, 0 : 10e-3, 8e-3, 4e-3
      set insertion distance threshold = 1.1
      set insertion maximum offset = 0.1
      set initial velocity = 0, -2, 0.3
    end
    subsection model parameters
      set largest overlap = 0   # the impacts are hard
      subsection contact detection
        set neighborhood threshold = )" +
         threshold + "\n end\n subsection load balancing\n" + balancing + "\n end\nend\n";
}

/// The particles at the end, then all thresholds that there were, then the numbers of contacts that
/// were missed and that there were.
Numbers run(const std::string &text, MPI_Comm comm)
{
  Case test_case(text, comm);
  Touching touching;
  std::vector<double> thresholds;
  constexpr unsigned int interval = 23; // so that it falls on all places between searches
  unsigned int n = 0;
  test_case.run([&](Simulation &simulation) {
    const double threshold = simulation.get_system().neighborhood_threshold();
    if (thresholds.empty() || threshold != thresholds.back())
      thresholds.push_back(threshold);
    if (n++ % interval == 0)
      touching.count(simulation, depth);
  });
  const std::size_t n_missed = dealii::Utilities::MPI::sum(touching.n_missed, comm);
  Numbers all = particle_table(*test_case);
  all.push_back(thresholds);
  all.push_back({static_cast<double>(n_missed), static_cast<double>(touching.n)});
  return all;
}

void check_tuned(const std::string &name, const std::string &balancing)
{
  const Numbers found = same_on_one_rank(
      name, [&](MPI_Comm comm) { return run(input("auto", "0.01", balancing), comm); });
  const std::vector<double> &thresholds = found[found.size() - 2], &contacts = found.back();
  check(name + ": all particles are there", found.size() == 202);
  check(name + ": the skin follows the flow", thresholds.size() > 1);
  check(name + ": no contact is missed", contacts[0] == 0. && contacts[1] > 100.,
        std::to_string(contacts[0]) + " of " + std::to_string(contacts[1]));
}

/// Largest distance of two particles of the same id (m).
double largest_difference(const Numbers &a, const Numbers &b)
{
  double largest = 0.;
  for (std::size_t k = 0; k < 200; ++k)
    for (const Column c : {c_x, c_y, c_z}) {
      const double apart = a[k][c] - b[k][c];
      // Whether a particle is brought back at a periodic end depends on when contacts are searched.
      largest = std::max(largest, std::abs(c == c_z ? std::remainder(apart, depth) : apart));
    }
  return largest;
}

} // namespace

EUNOE_MPI_TEST()
{
  check_tuned("ranks as they are", "set load balance method = none");
  check_tuned("shared out anew", "set load balance method = frequent\n set frequency = 100");
  // So short that differences have not grown yet.
  const Numbers usual = run(input("1.3", "0.002"), MPI_COMM_WORLD);
  for (const std::string threshold : {"1.05", "1.9"})
    check_close("a threshold of " + threshold + ": the same motion",
                largest_difference(run(input(threshold, "0.002"), MPI_COMM_WORLD), usual), 0.,
                1e-10);
}
