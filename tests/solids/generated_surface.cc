// Surfaces of deal.II's generators: a closed sphere of the right size, and a rectangle like the
// plane that is made in code; an unknown generator is refused.

#include <eunoe/solids/solid_parameters.h>

#include "surfaces.h"

using namespace test;

EUNOE_TEST()
{
  const TriangleMesh sphere = generate_surface("hyper_sphere", "1, 2, 3 : 0.5", 3);
  check("768 triangles", sphere.triangles.size() == 768);
  bool on_sphere = true;
  for (const Vec3 &x : sphere.vertices)
    on_sphere = on_sphere && std::abs(norm(x - Vec3{1., 2., 3.}) - 0.5) < 1e-12;
  check("all corners on the sphere", on_sphere);
  check_relative("area", area(sphere), M_PI, 0.02);
  check("closed", open_length(sphere) == 0.);

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
