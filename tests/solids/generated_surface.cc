// Surfaces of deal.II's generators: a sphere of the right size without gaps, a rectangle like the
// plane that is made in code; and what is no generator is refused.

#include <eunoe/solids/solid_parameters.h>

#include "surfaces.h"

#include <map>

using namespace test;

namespace {

double area(const TriangleMesh &mesh)
{
  double sum = 0.;
  for (const auto &t : mesh.triangles)
    sum += 0.5 * norm(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]],
                            mesh.vertices[t[2]] - mesh.vertices[t[0]]));
  return sum;
}

} // namespace

int main()
{
  TriangleMesh sphere = generate_surface("hyper_sphere", "1, 2, 3 : 0.5", 3);
  check("768 triangles", sphere.triangles.size() == 768);
  bool on_sphere = true;
  for (const Vec3 &x : sphere.vertices)
    on_sphere = on_sphere && std::abs(norm(x - Vec3{1., 2., 3.}) - 0.5) < 1e-12;
  check("all corners on the sphere", on_sphere);
  check_relative("area", area(sphere), M_PI, 0.02);
  sphere.merge_vertices(1e-9);
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  for (const auto &t : sphere.triangles)
    for (unsigned int k = 0; k < 3; ++k)
      ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  check("closed",
        std::all_of(uses.begin(), uses.end(), [](const auto &edge) { return edge.second == 2; }));

  const TriangleMesh rectangle = generate_surface("hyper_rectangle", "-1, -2 : 1, 2 : false", 2);
  check("rectangle", rectangle.triangles.size() == 32 && std::abs(area(rectangle) - 8.) < 1e-12);
  try {
    generate_surface("torus_knot", "1", 0);
    check("no generator is refused", false);
  } catch (const std::invalid_argument &error) {
    check("no generator is refused",
          std::string(error.what()).find("the surface cannot be made (") == 0);
  }
}
