#include "announcements.h"

#include <eunoe/core/log.h>
#include <eunoe/core/machine.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/domain/mesh.h>
#include <eunoe/simulation/parameters.h>

#include <cmath>
#include <filesystem>

namespace eunoe {

namespace {

/// Size of a file (bytes), 0 if there is none.
double size_of(const std::string &file)
{
  std::error_code failure;
  const auto size = std::filesystem::file_size(file, failure);
  return failure ? 0. : static_cast<double>(size);
}

} // namespace

void announce_insertion(const Parameters &parameters, Log &log)
{
  // Each takes a second, more or less.
  constexpr double many_points = 2e6, many_bytes = 5e7;
  const InsertionParameters &p = parameters.insertion;
  if (p.method == "file")
    for (const std::string &file : p.files)
      if (size_of(file) > many_bytes)
        log.line("Reading " + format_bytes(size_of(file)) + " of particles from " +
                 shortened(file) + " ...");
  if (p.method == "volume" && p.acceptance != "1") {
    const double pitch = p.distance_threshold * parameters.physics.largest_diameter();
    const Vec3 size = p.box_upper - p.box_lower;
    const double points = size.x * size.y * size.z / (pitch * pitch * pitch);
    if (points > many_points)
      log.line("Asking the insertion acceptance function at about " + format(points) +
               " points ...");
  }
}

void announce_mesh(const Background &background, Log &log)
{
  constexpr double many_cells = 3e5, many_bytes = 2e7;
  const MeshParameters &mesh = background.mesh;
  const bool is_sketched = background.is_only_looked_at && background.refinement.regions.empty() &&
                           sketch_of(mesh).has_value();
  if (is_sketched)
    return;
  if (mesh.type == "gmsh" && size_of(mesh.file) > many_bytes)
    log.line("Reading a mesh of " + format_bytes(size_of(mesh.file)) + " from " +
             shortened(mesh.file) + " ...");
  const double cells = expected_cells(mesh);
  if (cells > many_cells && cells <= most_cells)
    log.line("Making a mesh of " + format(cells) + " cells or more ...");
}

} // namespace eunoe
