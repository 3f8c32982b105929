// Any text as an input file, as --check treats it: all parts of a run are built.

#include <eunoe/simulation/simulation.h>

#include "fuzzing.h"
#include "input_mutator.h"

namespace {

/// Whether the mesh has so many cells that making it takes seconds.
bool is_large(const eunoe::MeshParameters &mesh)
{
  double n[3] = {1., 1., 1.};
  std::sscanf(mesh.grid_arguments.c_str(), "%lf ,%lf ,%lf", n, n + 1, n + 2);
  return mesh.grid_type == "subdivided_hyper_rectangle" && n[0] * n[1] * n[2] > 1e4 &&
         n[0] * n[1] * n[2] < 1e7;
}

/// Whether a case is not for this fuzzer: it reads other files, which have their own fuzzers, or
/// has a mesh that is not made of boxes or refined more than once and may rightly take long.
bool is_out_of_scope(const eunoe::Parameters &parameters)
{
  const auto &mesh = parameters.mesh;
  if (parameters.process_name == "none" &&
      (mesh.type == "gmsh" || mesh.refinement > 1 ||
       mesh.grid_type.find("hyper_rectangle") == std::string::npos ||
       parameters.insertion.method == "file"))
    return true;
  for (const auto &object : parameters.solids.objects)
    if (object.type == "gmsh")
      return true;
  return parameters.restart.restart != "false";
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  eunoe::Problems problems;
  const eunoe::Parameters parameters = fuzzing::read(std::string(data, data + size), problems);
  if (!problems.empty() || is_out_of_scope(parameters))
    return 0;
  eunoe::Log log(MPI_COMM_WORLD, true);
  try {
    const eunoe::MeshParameters mesh = parameters.of_run().mesh;
    if (is_large(mesh) || mesh.refinement > 4)
      return 0;
    const eunoe::Simulation simulation(parameters, MPI_COMM_WORLD, log);
    (void)simulation.estimate();
  } catch (const eunoe::UserError &) {
  }
  return 0;
}
