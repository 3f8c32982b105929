// Spheres that slide and roll across hundreds of triangles, along edges, over corners and
// obliquely, move exactly as on two large triangles and on an infinite plane, with friction, its
// memory, cohesion and rolling resistance; on a tilted plane the three agree to round-off.
// Regression: other programs had double contacts and lost the memory at the shared edges of
// triangles.

#include "surfaces.h"

using namespace test;

namespace {

const Vec3 corner = {-8e-3, -1.3e-3, -4e-3}, u = {16e-3, 0., 0.}, v = {0., 0., 8e-3};

/// All spheres after every step.
using Track = std::vector<std::vector<TouchingSphere>>;

Track run(const Powder &powder, const std::vector<Start> &starts, const std::string &surface)
{
  Track track;
  Case test_case(box_input(1e-5, 0.02, powder.input() + insertion_input(starts) + surface));
  test_case.run([&track](Simulation &simulation) { track.push_back(spheres(simulation)); });
  return track;
}

std::string argument(const Vec3 &a, const Vec3 &b, const Vec3 &c)
{
  return text_of(a) + " : " + text_of(b) + " : " + text_of(c);
}

bool same_bits(const Track &a, const Track &b)
{
  bool same = a.size() == b.size();
  for (std::size_t step = 0; step < a.size() && same; ++step)
    for (std::size_t k = 0; k < a[step].size(); ++k) {
      const TouchingSphere &s = a[step][k], &t = b[step][k];
      same = same && s.position == t.position && s.velocity == t.velocity && s.spin == t.spin &&
             s.force == t.force && s.torque == t.torque && s.memories == t.memories;
    }
  return same;
}

double largest_difference(const Track &a, const Track &b, Vec3 TouchingSphere::*vector)
{
  double largest = 0.;
  for (std::size_t step = 0; step < a.size(); ++step)
    for (std::size_t k = 0; k < a[step].size(); ++k)
      largest = std::max(largest, norm(a[step][k].*vector - b[step][k].*vector));
  return largest;
}

/// Steps at which a sphere does not have exactly one contact.
int steps_without_one_contact(const Track &track)
{
  // A contact is remembered from the first step on.
  return static_cast<int>(std::count_if(track.begin() + 1, track.end(), [](const auto &all) {
    return std::any_of(all.begin(), all.end(),
                       [](const TouchingSphere &s) { return s.normals.size() != 1; });
  }));
}

} // namespace

EUNOE_MPI_TEST()
{
  Powder powder;
  powder.gravity = {0., -9.81, 0.};
  powder.friction = 0.2;
  powder.rolling_friction = 0.1;
  powder.surface_energy = 1e-3;
  const TriangleMesh mesh = uneven_plate(corner, u, v, 40, 20);
  const double height = corner.y + powder.radius() - powder.overlap(powder.mass() * 9.81);

  // One slides along a row of edges; one obliquely, with spin; one rolls; one starts over a corner,
  // driven by its spin; one falls and bounces.
  const Vec3 over_corner = mesh.vertices[41 * 18 + 30];
  const std::vector<Start> starts = {
      {{-7e-3, height, 0.}, {0.5, 0., 0.}, {}},
      {{-6e-3, height, -3e-3}, {0.4, 0., 0.08}, {30., -50., 80.}},
      {{6e-3, height, 1.5e-3}, {-0.3, 0., 0.05}, {-100., 0., 600.}},
      {{over_corner.x, height, over_corner.z}, {}, {300., 0., 1000.}},
      {{-5e-3, height + 1e-4, 3.1e-3}, {0.4, 0., 0.}, {0., 200., 0.}}};

  write_gmsh(mesh, "plate.msh");
  const Track many = run(powder, starts, gmsh_input("plate.msh"));
  const Track two = run(powder, starts, shape_input("plane", argument(corner, u, v)));
  const Track plane = run(powder, starts, walls_input({{corner, {0., 3., 0.}}}));
  const Vec3 path = many.back()[0].position - starts[0].position;
  check("the first slides along the edges", path.z == 0. && path.x > 8e-3);
  check("it rolls the more", many.back()[0].spin.z < -50.);
  check("same bits as on two triangles", same_bits(many, two));
  check("same bits as on an infinite plane", same_bits(many, plane));

  // The same, turned as a whole; without the falling sphere.
  const Rotation turn = Rotation::by({0.3, -0.5, 0.2});
  std::vector<Start> turned_starts(starts.begin(), starts.end() - 1);
  for (Start &start : turned_starts)
    start = {turn.apply(start.position), turn.apply(start.velocity), turn.apply(start.spin)};
  TriangleMesh turned_mesh = mesh;
  for (Vec3 &x : turned_mesh.vertices)
    x = turn.apply(x);
  powder.gravity = turn.apply(powder.gravity);
  const Vec3 turned_corner = turn.apply(corner);
  write_gmsh(turned_mesh, "turned.msh");
  const Track turned = run(powder, turned_starts, gmsh_input("turned.msh"));
  const Track turned_two =
      run(powder, turned_starts,
          shape_input("plane", argument(turned_corner, turn.apply(u), turn.apply(v))));
  const Track turned_plane =
      run(powder, turned_starts, walls_input({{turned_corner, turn.apply({0., 3., 0.})}}));
  check("one contact at any time", steps_without_one_contact(turned) == 0);
  for (const auto &[name, other] :
       {std::pair("two triangles", &turned_two), std::pair("a plane", &turned_plane)})
  {
    const std::string what = std::string(" is that on ") + name;
    // Round-off of the coordinates, 1e-18 m, is 1e-12 of the overlap and so of the force.
    check_close("path" + what, largest_difference(turned, *other, &TouchingSphere::position), 0.,
                1e-15);
    check_close("velocity" + what, largest_difference(turned, *other, &TouchingSphere::velocity),
                0., 1e-12);
    check_close("spin" + what, largest_difference(turned, *other, &TouchingSphere::spin), 0., 2e-9);
  }
}
