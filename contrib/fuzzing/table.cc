// Any text as a table of particles.

#include <eunoe/simulation/insertion.h>

#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  const fuzzing::MemoryFile file(data, size);
  eunoe::InsertionParameters parameters;
  parameters.method = "file";
  parameters.files = {file.path()};
  try {
    const auto insertion = eunoe::insertion_methods().make(
        parameters.method, parameters, eunoe::PhysicalProperties(1), MPI_COMM_WORLD);
    eunoe::ParticleIds ids;
    insertion->next(ids);
  } catch (const eunoe::UserError &) {
  }
  return 0;
}
