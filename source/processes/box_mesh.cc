#include <eunoe/core/problems.h>
#include <eunoe/processes/box_mesh.h>

#include <algorithm>
#include <cmath>

namespace eunoe {

namespace {

/// The mesh is not the user's, so what is wrong with it is said of the lengths that decide it.
void refuse_too_large(const std::string &section, const Vec3 &size, const double largest_diameter,
                      const double coarse_cells, const double refined)
{
  // Somewhat below what a mesh may have.
  constexpr double most_cells = 9e8, most_coarse = 9e6;
  const double most = std::min(most_cells, most_coarse * refined), cells = coarse_cells * refined;
  if (!(cells < most))
    throw UserError("subsection '" + section + "': the apparatus would be " + format(size.x) +
                    " m long in x, " + format(size.y) + " m in y and " + format(size.z) +
                    " m in z, too large for particles of " + format(largest_diameter) +
                    " m: it would be made of " + format(cells) + " cells, and at most " +
                    format(most) +
                    " are possible. Correct the length that is too large, or the diameters; all "
                    "are in metres.");
}

} // namespace

MeshParameters box_mesh(const std::string &section, const Vec3 &lower, const Vec3 &upper,
                        const double largest_diameter, const double skin)
{
  const double reach = 1.02 * (largest_diameter + skin);
  const double width = std::max(1.5 * largest_diameter, reach);
  unsigned int cells[3];
  for (unsigned int d = 0; d < 3; ++d) {
    const double number = (upper[d] - lower[d]) / width;
    cells[d] = number >= 1. ? static_cast<unsigned int>(std::min(number, 1e9)) : 1;
  }
  const unsigned int fewest = *std::min_element(cells, cells + 3);
  unsigned int refinement = 0;
  while ((2u << refinement) <= fewest && refinement < 4)
    ++refinement;
  std::string counts;
  double coarse = 1.;
  for (unsigned int d = 0; d < 3; ++d) {
    const unsigned int count = std::max(1u, cells[d] >> refinement);
    counts += (d > 0 ? ", " : "") + std::to_string(count);
    coarse *= count;
  }
  refuse_too_large(section, upper - lower, largest_diameter, coarse, std::pow(8., refinement));

  char corners[256];
  std::snprintf(corners, sizeof corners, " : %.17g, %.17g, %.17g : %.17g, %.17g, %.17g : true",
                lower.x, lower.y, lower.z, upper.x, upper.y, upper.z);
  MeshParameters mesh;
  mesh.grid_type = "subdivided_hyper_rectangle";
  mesh.grid_arguments = counts + corners;
  mesh.refinement = refinement;
  return mesh;
}

} // namespace eunoe
