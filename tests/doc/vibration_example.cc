// Reads a vibrating solid from an input text and compares its position and velocity with
// centre + A sin(2 pi f t) and its derivative. Built by contributing_examples.py with the code of
// CONTRIBUTING.md.

#include <eunoe/core/mpi_session.h>
#include <eunoe/solids/solid_parameters.h>

#include <deal.II/base/parameter_handler.h>

#include <cmath>
#include <cstdio>

int main(int, char **argv)
{
  using namespace eunoe;
  const eunoe::MpiSession mpi(argv);
  SolidObjectParameters parameters(1);
  dealii::ParameterHandler prm;
  parameters.declare(prm);
  prm.parse_input_from_string("subsection solid objects\n subsection solid surfaces\n"
                              "  subsection solid object 0\n   subsection mesh\n"
                              "    set type = shape\n   end\n"
                              "   set center of rotation = 1e-3, 2e-3, 3e-3\n"
                              "   set vibration amplitude = 1e-4, 0, -2e-4\n"
                              "   set vibration frequency = 50\n  end\n end\nend\n");
  Problems problems;
  const std::vector<Solid> solids = parameters.make(0, 1e-6, MPI_COMM_SELF, problems);
  if (!problems.empty() || solids.size() != 1)
    return 1;
  const double time = 1.7e-3, phase = 2. * M_PI * 50. * time;
  const Vec3 centre = {1e-3, 2e-3, 3e-3}, amplitude = {1e-4, 0., -2e-4};
  const RigidState state = solids[0].motion->at(time);
  const double off_place = norm(state.centre - centre - std::sin(phase) * amplitude);
  const double off_velocity = norm(state.velocity - 2. * M_PI * 50. * std::cos(phase) * amplitude);
  std::printf("off its place by %g m, off its velocity by %g m/s\n", off_place, off_velocity);
  return off_place < 1e-15 && off_velocity < 1e-13 ? 0 : 1;
}
