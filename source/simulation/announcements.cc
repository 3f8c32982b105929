#include "announcements.h"

#include <eunoe/core/files.h>
#include <eunoe/core/log.h>
#include <eunoe/core/machine.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/domain/mesh.h>
#include <eunoe/simulation/parameters.h>

#include <cmath>

namespace eunoe {

void announce_mesh(const Background &background, Log &log)
{
  constexpr double many_cells = 3e5, many_bytes = 2e7;
  const MeshParameters &mesh = background.mesh;
  const bool is_sketched = !background.needs_cells && background.refinement.regions.empty() &&
                           sketch_of(mesh).has_value();
  if (is_sketched)
    return;
  if (mesh.type == "gmsh" && file_size(mesh.file) > many_bytes)
    log.line("Reading a mesh of " + format_bytes(file_size(mesh.file)) + " from " +
             shortened(mesh.file) + " ...");
  const double cells = expected_cells(mesh);
  if (cells > many_cells && cells <= most_cells)
    log.line("Making a mesh of " + format(cells) + " cells or more ...");
}

} // namespace eunoe
