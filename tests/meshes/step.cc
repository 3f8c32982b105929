// A mesh with a step whose edge points into the domain: spheres touch the walls according to their
// distance from the step, whatever the mesh cells, and a ball balances on the edge.

#include "meshes.h"

#include <random>

using namespace test;

namespace {

constexpr double r = 0.5e-3;

/// The quarter x < 0, y < 0 is missing.
void write_step()
{
  Profile section;
  section.points = {{{-8e-3, 0.}}, {{0., 0.}},     {{8e-3, 0.}},  {{-8e-3, 8e-3}},
                    {{0., 8e-3}},  {{8e-3, 8e-3}}, {{0., -8e-3}}, {{8e-3, -8e-3}}};
  section.quads = {{{0, 1, 4, 3}}, {{1, 2, 5, 4}}, {{6, 7, 2, 1}}};
  // The tread and the riser have ids of their own.
  section.ids = {{{{0, 1}}, 3}, {{{1, 6}}, 4}};
  section.depth = 8e-3;
  write_mesh(section, "step.msh");
}

/// Distances of the walls that a sphere touches and unit normals into them, sorted by the distance.
std::vector<std::pair<double, Vec3>> contacts(const Domain &domain, const Vec3 &x)
{
  std::vector<std::pair<double, Vec3>> all;
  for (const Solid &wall : domain.walls()) {
    std::vector<std::int32_t> facets;
    std::array<SurfaceContact, Shape::max_contacts> found;
    wall.shape->find_facets(x, r, facets);
    const unsigned int n = wall.shape->find_contacts(x, r, r, facets.data(),
                                                     facets.data() + facets.size(), found.data());
    for (unsigned int k = 0; k < n; ++k)
      all.emplace_back(found[k].distance, found[k].normal);
  }
  std::sort(all.begin(), all.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
  return all;
}

void touches(const Domain &domain)
{
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> near(-2. * r, 2. * r), along(r, 8e-3 - r);
  unsigned int wrong = 0, on_edge = 0;
  for (unsigned int k = 0; k < 20000; ++k) {
    const Vec3 x = {near(generator), near(generator), along(generator)};
    if (x.x < 0. && x.y < 0.)
      continue;
    const Vec3 to_step = x.x < 0.   ? Vec3{0., -x.y, 0.}
                         : x.y < 0. ? Vec3{-x.x, 0., 0.}
                                    : Vec3{-x.x, -x.y, 0.};
    const auto found = contacts(domain, x);
    const double distance = norm(to_step);
    if (distance >= r) {
      wrong += found.empty() ? 0 : 1;
      continue;
    }
    on_edge += x.x > 0. && x.y > 0. ? 1 : 0;
    if (found.size() != 1 || std::abs(found[0].first - distance) > 1e-12 * r ||
        norm(found[0].second - to_step / distance) > 1e-9)
      ++wrong;
  }
  check("spheres touch the edge", on_edge > 500);
  check("each touches the step where it is nearest", wrong == 0,
        std::to_string(wrong) + " are wrong");
  check("in the corner below, floor and riser",
        contacts(domain, {0.9 * r, -8e-3 + 0.8 * r, 4e-3}).size() == 2);
  check("it contains what is above the step", domain.contains({-1e-3, 1e-3, 4e-3}));
  check("and not what is in it", !domain.contains({-1e-3, -1e-3, 4e-3}));
  check("nor what is outside", !domain.contains({9e-3, 1e-3, 4e-3}));
}

/// Gravity acts through the edge, so the force of the edge alone must balance the ball.
void balance()
{
  const double g = 9.81, mass = 1000. * 4. / 3. * M_PI * r * r * r;
  const double young = 1e6 / (2. * (1. - 0.09));
  const double overlap = std::pow(mass * g / (4. / 3. * young * std::sqrt(r)), 2. / 3.);
  const double place = std::sqrt(0.5) * (r - overlap);
  Case test_case(control(1e-5, 0.01) + gmsh_mesh("step.msh", 1) +
                 powder(2. * r, 0.5, 0.3, "-6.936717523440031, -6.936717523440031, 0") +
                 places({{place, place, 3e-3}}, {Vec3()}));
  test_case.run();
  const std::vector<double> row = particle_table(*test_case)[0];
  check_close("it balances: x", row[c_x], place, 1e-9);
  check_close("it balances: y", row[c_y], place, 1e-9);
}

/// A ball without friction slides over the shelf, across the faces between mesh cells, without a
/// bump.
void slides()
{
  const double speed = 0.1, g = 9.81, mass = 1000. * 4. / 3. * M_PI * r * r * r;
  const double young = 1e6 / (2. * (1. - 0.09));
  const double overlap = std::pow(mass * g / (4. / 3. * young * std::sqrt(r)), 2. / 3.);
  Case test_case(control(1e-5, 0.06) + gmsh_mesh("step.msh", 2) +
                 powder(2. * r, 0.5, 0., "0, -9.81, 0") +
                 places({{-7e-3, r - overlap, 3e-3}}, {{speed, 0., 0.}}));
  double highest = 0., lowest = 1.;
  test_case.run([&](Simulation &simulation) {
    const double y = particle_table(simulation)[0][c_y];
    highest = std::max(highest, y);
    lowest = std::min(lowest, y);
  });
  const std::vector<double> row = particle_table(*test_case)[0];
  check_close("it slides over the shelf: x", row[c_x], -7e-3 + speed * 0.06, 1e-12);
  check_close("it slides over the shelf: highest", highest, r - overlap, 1e-12);
  check_close("it slides over the shelf: lowest", lowest, r - overlap, 1e-12);
}

/// Two boundaries in one plane: over the line between them a sphere has one contact; if one of them
/// is an outlet, it is no wall.
void floor_of_two()
{
  Profile section;
  section.points = {{{-8e-3, 0.}},   {{0., 0.}},   {{8e-3, 0.}},
                    {{-8e-3, 8e-3}}, {{0., 8e-3}}, {{8e-3, 8e-3}}};
  section.quads = {{{0, 1, 4, 3}}, {{1, 2, 5, 4}}};
  section.ids = {{{{0, 1}}, 3}, {{{1, 2}}, 4}};
  section.depth = 8e-3;
  write_mesh(section, "floor.msh");
  const std::string input =
      control(1e-5, 0.05) + gmsh_mesh("floor.msh", 1) + powder(2. * r, 0.5, 0., "0, -9.81, 0");
  Case walls(input);
  unsigned int wrong = 0;
  for (double x = -2. * r; x < 2. * r; x += 0.01 * r)
    wrong += contacts(walls->get_domain(), {x, 0.99 * r, 4e-3}).size() == 1 ? 0 : 1;
  check("one contact over the line between two boundaries", wrong == 0);

  Case hole(input +
            "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
            " subsection boundary condition 0\n  set type = outlet\n  set boundary id = 4\n"
            " end\nend\n" +
            places({{-3e-3, 2e-3, 4e-3}, {3e-3, 2e-3, 4e-3}}, {Vec3(), Vec3()}));
  hole.run();
  const auto left = particle_table(*hole);
  check("one falls through the hole beside the floor, one stays",
        left.size() == 1 && left[0][c_id] == 1. && left[0][c_y] > 0.);
}

} // namespace

EUNOE_MPI_TEST()
{
  write_step();
  for (const unsigned int refinement : {0, 2}) {
    Case test_case(control(1e-5, 1e-5) + gmsh_mesh("step.msh", refinement) +
                   powder(2. * r, 0.5, 0.3, "0, 0, 0"));
    touches(test_case->get_domain());
  }
  balance();
  slides();
  floor_of_two();
}
