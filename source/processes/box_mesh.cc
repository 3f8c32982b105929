#include <eunoe/processes/box_mesh.h>

#include <algorithm>

namespace eunoe {

MeshParameters box_mesh(const Vec3 &lower, const Vec3 &upper, const double largest_diameter,
                        const double skin)
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
