// Refining the mesh in boxes, also below the size of the particles, changes no bit of the results:
// a cohesive powder in a domain with two periodic directions, where a periodic face is partly finer
// than the opposite one, against the plain mesh on one rank; on any number of ranks, with and
// without load balancing.

#include "meshes.h"

using namespace test;

namespace {

using Table = std::vector<std::vector<double>>;

const std::string boxes =
    refinement({"0, 0, 0 : 4e-3, 5e-3, 5e-3", "9e-3, 0, 3e-3 : 11e-3, 2e-3, 9e-3"});

Table run(const std::string &more, MPI_Comm comm, std::uint64_t *n_cells = nullptr)
{
  Case test_case(
      control(5e-6, 0.03) +
          generated_mesh("subdivided_hyper_rectangle",
                         "4, 4, 4 : 0, 0, 0 : 12e-3, 12e-3, 12e-3 : true", 0) +
          powder(0.8e-3, 0.5, 0.4, "2, -9.81, 1",
                 "  set number of particles = 400\n  set surface energy particles = 0.01\n") +
          periodic_in({0, 2}) + R"(
    subsection lagrangian physical properties
      set surface energy wall = 0.01
    end
    subsection insertion info
      set insertion box points coordinates = 0, 2e-3, 0 : 12e-3, 12e-3, 12e-3
      set insertion distance threshold = 1.2
      set insertion maximum offset = 0.2
      set initial velocity = 0.3, -0.5, 0.4
    end
    subsection model parameters
      set particle particle contact force method = DMT
      set particle wall contact force method = DMT
      subsection contact detection
        set neighborhood threshold = 1.2
      end
    end
)" + more,
      comm);
  test_case.run();
  if (n_cells != nullptr)
    *n_cells = test_case->get_domain().n_cells();
  return particle_table(*test_case);
}

/// Number of mesh cells of a box of 3 x 4 x 12 m, whose diagonal is 13 m, refined to a target size.
std::uint64_t cells_for(double target_size)
{
  std::ostringstream entries;
  entries << " set enable target size = true\n set target size = " << target_size << "\n";
  Case test_case(control(1e-5, 1e-5) + generated_mesh("hyper_rectangle",
                                                      "0, 0, 0 : 3, 4, 12 : true", 5,
                                                      entries.str()),
                 MPI_COMM_WORLD);
  return test_case->get_domain().n_cells();
}

} // namespace

EUNOE_MPI_TEST()
{
  Table plain;
  if (is_first_rank())
    plain = run("", MPI_COMM_SELF);
  for (const std::string &balancing :
       {std::string("set load balance method = none"),
        std::string("set load balance method = frequent\n set frequency = 200\n"
                    " subsection cell weight function\n"
                    "  set Function expression = 100 + 1e5 * x\n end")})
  {
    std::uint64_t n_cells = 0;
    const Table refined =
        run(std::string(boxes) + "subsection model parameters\n subsection load balancing\n" +
                balancing + "\n end\nend\n",
            MPI_COMM_WORLD, &n_cells);
    // The two boxes refine 2 x 2 x 2 and 1 x 1 x 2 mesh cells.
    check("10 of 64 cells are cut into eight", n_cells == 64 + 7 * 10,
          std::to_string(n_cells) + " cells");
    check("all particles are there", refined.size() == 400);
    check("the same bits as with a plain mesh on one rank", refined == plain || !is_first_rank());
  }
  check("the same bits with mesh cells of a quarter of a diameter",
        run(refinement({"0, 0, 0 : 1e-3, 1e-3, 1e-3"}, 4), MPI_COMM_WORLD) == plain ||
            !is_first_rank());
  check("target size: not coarser than the mesh is", cells_for(20.) == 1);
  check("target size: cut until the next cut would pass it",
        cells_for(6.4) == 8 && cells_for(3.3) == 8 && cells_for(3.2) == 64);
}
