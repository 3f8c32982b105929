// Particles rain through outlets: those inserted are inside or have left, in number and, to the
// last bit, in mass; on any number of ranks.

#include "../tests.h"

using namespace test;

namespace {

const char *const rain_input = R"(
    subsection DEM boundary conditions
      set number of boundary conditions = 2
      subsection boundary condition 0
        set boundary id = 2
        set type = outlet
      end
      subsection boundary condition 1
        set boundary id = 1
        set type = outlet
      end
    end
    subsection lagrangian physical properties
      set g = 1, -9.81, 0
      subsection particle type 0
        set size distribution type = normal
        set average diameter = 1e-3
        set standard deviation = 2e-4
        set number of particles = 300
      end
    end
    subsection insertion info
      set inserted number of particles at each time step = 100
      set insertion frequency = 700
      set insertion box points coordinates = -0.01, 0, -0.01 : 0.01, 0.01, 0.01
      set insertion distance threshold = 1.3
      set insertion maximum offset = 0.3
    end
    subsection model parameters
      set largest overlap = 0   # more is inserted where some still are
      subsection load balancing
        set load balance method = frequent
        set frequency = 300
      end
    end)";

} // namespace

EUNOE_MPI_TEST()
{
  Case rain(box_input(2e-5, 0.05, rain_input));
  rain.run();

  const MPI_Comm comm = MPI_COMM_WORLD;
  const Ledger &ledger = rain->get_ledger();
  const Tally inserted = ledger.inserted.global(comm);
  Tally outside, inside;
  for (const Tally &outlet : ledger.through_outlet) {
    const Tally out = outlet.global(comm);
    check("something left", out.number > 0);
    outside.number += out.number;
    outside.mass += out.mass;
  }
  const ParticleArrays &p = rain->complete_step();
  for (std::size_t k = 0; k < p.n_owned; ++k)
    inside.count(p.mass(k));
  inside = inside.global(comm);
  check("three batches were inserted", inserted.number == 300);
  check("something stayed", inside.number > 0);
  check("numbers add up", inside.number + outside.number == inserted.number);
  ExactSum sum = inside.mass;
  sum += outside.mass;
  check("masses add up exactly", sum == inserted.mass);

  // Most leave at searches after which the others are in the same order as before.
  const ParticleSystem &system = rain->get_system();
  check("the store counts those inside", system.n_global() == inside.number);
  check("searches in place", 4 * system.n_searches_in_place() > 3 * system.n_searches(),
        std::to_string(system.n_searches_in_place()) + " of " +
            std::to_string(system.n_searches()));

  bool in_domain = true;
  for (std::size_t k = 0; k < p.n_owned; ++k)
    in_domain = in_domain && p.position[k].y > -0.0105 && p.position[k].x < 0.0105;
  check("nobody is far beyond an outlet", in_domain);
}
