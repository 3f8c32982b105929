// Any text as a table of particles.

#include <eunoe/simulation/insertion.h>

#include <deal.II/base/parameter_handler.h>

#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  const fuzzing::MemoryFile file(data, size);
  eunoe::InsertionParameters parameters;
  dealii::ParameterHandler prm;
  parameters.declare(prm);
  prm.parse_input_from_string("subsection insertion info\n set insertion method = file\n"
                              " set list of input files = " +
                              file.path() + "\nend\n");
  try {
    const auto insertion =
        parameters.chosen().make(parameters, eunoe::PhysicalProperties(1), MPI_COMM_WORLD);
    eunoe::ParticleIds ids;
    insertion->next(ids);
  } catch (const eunoe::UserError &) {
  }
  return 0;
}
