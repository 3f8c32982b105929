// Any text as a Gmsh file of a solid, and spheres that touch the surface.

#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  const fuzzing::MemoryFile file(data, size);
  try {
    const eunoe::TriangleMesh mesh = eunoe::read_gmsh(file.path(), MPI_COMM_WORLD);
    if (!mesh.defect().empty())
      return 0;
    const eunoe::TriangulatedSurface surface(mesh);
    std::vector<std::int32_t> facets;
    for (const eunoe::Vec3 &place : mesh.vertices) {
      constexpr double radius = 0.1;
      facets.clear();
      surface.find_facets(place, radius, facets);
      eunoe::SurfaceContact contacts[eunoe::Shape::max_contacts];
      surface.find_contacts(place + eunoe::Vec3{0., 0., 0.5 * radius}, radius, radius,
                            facets.data(), facets.data() + facets.size(), contacts);
    }
  } catch (const eunoe::UserError &) {
  }
  return 0;
}
