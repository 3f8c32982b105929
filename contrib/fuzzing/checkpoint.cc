// Any bytes as a checkpoint, with the right checksum, and all rows of all its sections.

#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/input_differences.h>

#include "checkpoint_image.h"
#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  const std::string image = fuzzing::checkpoint_image(std::string(data, data + size), "");
  const fuzzing::MemoryFile file(image.data(), image.size());
  try {
    const eunoe::Checkpoint checkpoint(file.path(), MPI_COMM_WORLD);
    for (const auto &section : checkpoint.head.at("sections"))
      checkpoint.rows(section.at("name"));
  } catch (const eunoe::UserError &) {
  }
  return 0;
}
