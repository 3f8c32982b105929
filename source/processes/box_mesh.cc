#include <eunoe/core/problems.h>
#include <eunoe/processes/box_mesh.h>

#include <algorithm>
#include <cmath>

namespace eunoe {

MeshParameters box_mesh(const std::string &section, const Vec3 &lower, const Vec3 &upper,
                        const double largest_diameter, const double skin)
{
  const double reach = 1.02 * (largest_diameter + skin);
  const double width = std::max(1.5 * largest_diameter, reach);
  // The mesh is not the user's, so what is wrong with it is said of the lengths that decide it.
  constexpr double most_cells = 8e8;
  const Vec3 size = upper - lower;
  const double number = size.x * size.y * size.z / std::pow(width, 3);
  if (!(number < most_cells))
    throw UserError("subsection '" + section + "': the apparatus would be " + format(size.x) +
                    " m long in x, " + format(size.y) + " m in y and " + format(size.z) +
                    " m in z, too large for particles of " + format(largest_diameter) +
                    " m: it would be made of " + format(number) + " cells, and at most " +
                    format(most_cells) +
                    " are possible. Correct the length that is too large, or the diameters; all "
                    "are in metres.");
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
  for (unsigned int d = 0; d < 3; ++d)
    counts += (d > 0 ? ", " : "") + std::to_string(std::max(1u, cells[d] >> refinement));

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
