// A run gives the same bits on any number of ranks, with and without load balancing: a cohesive
// powder rains into a periodic box, is stirred by a turning paddle, slides on a moving floor and
// leaves through an outlet, while more is inserted. The same with every law that acts across a
// separation and with drag. The first rank runs the case alone, then all ranks run it together.
// Meanwhile all particles are compared with all others: no list may lack a pair that touches.

#include "touching.h"

using namespace test;

namespace {

const char *const space = R"(
    subsection simulation control
      set time step = 4e-6
      set time end = 0.024
      set log frequency = 0
      set output path = results
    end
    subsection mesh
      set grid type = subdivided_hyper_rectangle
      set grid arguments = 5, 4, 2 : 0, 0, 0 : 10e-3, 8e-3, 4e-3 : true
      set initial refinement = 0
    end
    subsection DEM boundary conditions
      set number of boundary conditions = 3
      subsection boundary condition 0
        set type = periodic
        set periodic id 0 = 4
        set periodic id 1 = 5
        set periodic direction = 2
      end
      subsection boundary condition 1
        set type = outlet
        set boundary id = 1
      end
      subsection boundary condition 2
        set type = translational
        set boundary id = 2
        set speed x = 0.3
      end
    end
)";

const char *const powder = R"(
    subsection lagrangian physical properties
      set g = 0, -9.81, 0
      set number of particle types = 2
      subsection particle type 0
        set size distribution type = normal
        set average diameter = 0.7e-3
        set standard deviation = 0.1e-3
        set number of particles = 180
        set density particles = 2000
        set restitution coefficient particles = 0.5
        set friction coefficient particles = 0.4
        set surface energy particles = 0.01
      end
      subsection particle type 1
        set average diameter = 0.5e-3
        set number of particles = 90
        set restitution coefficient particles = 0.9
        set friction coefficient particles = 0.2
        set surface energy particles = 0.005
      end
      set friction coefficient wall = 0.5
      set restitution coefficient wall = 0.3
      set surface energy wall = 0.01
    end
)";

const std::string paddle =
    shape_input("box", "4e-3, 1e-3, -2e-3 : 5e-3, 3e-3, 6e-3",
                " set center of rotation = 4.5e-3, 2e-3, 0\n subsection angular velocity\n"
                "  set Function expression = 0; 0; 40\n end\n");

std::string input(const std::string &balancing)
{
  return std::string(space) + powder + R"(
    subsection insertion info
      set inserted number of particles at each time step = 90
      set insertion frequency = 1500
      set insertion box points coordinates = 0, 4e-3, 0 : 10e-3, 8e-3, 4e-3
      set insertion distance threshold = 1.1
      set insertion maximum offset = 0.1
      set initial velocity = 0, -0.5, 0.2
    end
    subsection model parameters
      set particle particle contact force method = DMT
      set particle wall contact force method = DMT
      set largest overlap = 0   # more is inserted where some still are
      set rolling resistance torque method = epsd
      set f coefficient = 0.1
      subsection contact detection
        set neighborhood threshold = 1.15
      end
      subsection load balancing
)" + balancing +
         R"(
      end
    end
)" + paddle;
}

struct Result
{
  std::vector<std::vector<double>> particles;
  std::vector<double> load;
  ExactSum lost;
  unsigned long long searches, in_place, balances;
  Touching touching;
};

/// Adhesion, liquid bridges, charges and drag instead of DMT, all strong enough to matter.
const char *const all_laws = R"(
    subsection lagrangian physical properties
      subsection particle type 0
        set surface charge density particles = 2e-5
      end
      subsection particle type 1
        set surface charge density particles = -1e-5
      end
    end
    subsection model parameters
      set particle particle contact force method = JKR
      set particle wall contact force method = JKR
      subsection capillary bridges
        set surface tension = 0.01
        set contact angle = 20
      end
      subsection electrostatic charge
        set cut-off share = 0.2
      end
      subsection drag
        set dynamic viscosity = 1e-3
        set density = 10
      end
    end
)";

const std::string none = "set load balance method = none";

Result run(const std::string &laws, const std::string &balancing, MPI_Comm comm)
{
  Case test_case(input(balancing) + laws +
                     "subsection post-processing\n subsection solid forces\n"
                     "  set calculation = true\n  set output frequency = 6000\n"
                     " end\nend\n",
                 comm);
  Result result;
  constexpr unsigned int interval = 23; // so that it falls on all places between searches
  unsigned int n = 0;
  test_case.run([&](Simulation &simulation) {
    if (n++ % interval == 0)
      result.touching.count(simulation, 4e-3);
  });
  MPI_Allreduce(MPI_IN_PLACE, &result.touching.n_missed, 1, MPI_UNSIGNED_LONG, MPI_SUM, comm);
  result.particles = particle_table(*test_case);
  const SolidLoad load = test_case->global_solid_loads().back();
  for (const ExactSum &component : load.force)
    result.load.push_back(component.value());
  result.lost = test_case->get_ledger().through_outlet[0].global(comm).mass;
  const ParticleSystem &system = test_case->get_system();
  result.searches = system.n_searches();
  result.in_place = system.n_searches_in_place();
  result.balances = system.n_balances();
  return result;
}

/// Both kinds of search must have happened for their equality to be seen.
void check_searches(const Result &result)
{
  check("searches of both kinds",
        4 * result.in_place > result.searches && result.in_place < result.searches,
        std::to_string(result.in_place) + " of " + std::to_string(result.searches) + " in place");
}

void compare(const std::string &laws, const std::vector<std::string> &balancings)
{
  int n_ranks;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  Result alone;
  if (is_first_rank())
    alone = run(laws, none, MPI_COMM_SELF);
  alone.particles = of_all_ranks(MPI_COMM_WORLD, alone.particles);
  for (const std::string &balancing : balancings) {
    const Result together = run(laws, balancing, MPI_COMM_WORLD);
    if (!is_first_rank())
      continue;
    check("all particles are there",
          together.particles.size() == alone.particles.size() && together.particles.size() > 150);
    check("the same bits", together.particles == alone.particles);
    const Touching &touching = together.touching;
    check("no contact is missed", touching.n_missed == 0 && touching.n > 5000,
          std::to_string(touching.n_missed) + " of " + std::to_string(touching.n));
    check("the same force on the paddle",
          together.load == alone.load && std::abs(alone.load[1]) > 0.);
    if (balancing == none)
      check_searches(together);
    if (n_ranks > 1)
      check("the work is shared out when the particles come", together.balances > 0);
    if (balancing != none && n_ranks > 1)
      check("the work was shared out anew", together.balances > 3,
            std::to_string(together.balances) + " times");
    check("the same mass lost", together.lost == alone.lost && alone.lost.value() > 0.);
  }
}

} // namespace

EUNOE_MPI_TEST()
{
  const char *const frequent = "set load balance method = frequent\n set frequency = 100";
  compare("", {none, frequent,
               "set load balance method = dynamic\n set threshold = 0.1\n set dynamic check "
               "frequency = 50"});
  compare(all_laws, {frequent});
}
