// Dense random packings: all particles are inserted at once, none overlaps another or leaves its
// box, periodic faces are no walls, and only places that the acceptance function allows are used;
// the packing is the same on any number of ranks, and the run continues with it. Reference:
// geometry.

#include "../on_one_rank.h"

using namespace test;

namespace {

std::string case_of_packing(unsigned int number, const std::string &insertion,
                            const std::string &more = "")
{
  return box_input(1e-6, 1e-6,
                   "subsection lagrangian physical properties\n subsection particle type 0\n"
                   "  set size distribution type = normal\n  set average diameter = 1e-3\n"
                   "  set standard deviation = 1e-4\n  set number of particles = " +
                       std::to_string(number) +
                       "\n end\nend\nsubsection insertion info\n set insertion method = packed\n"
                       " set insertion prn seed = 5\n" +
                       insertion + "end\n" + more);
}

/// Properties of a packing.
struct Result
{
  std::size_t number = 0;
  double largest_overlap = -1.; ///< over the sum of the radii, negative for a separation
  double volume = 0.;           ///< of all particles (m3)
  double order = 0.;            ///< a sum that changes with any digit
  Vec3 lowest = {1., 1., 1.}, highest = {-1., -1., -1.}; ///< of the surfaces (m)
};

Result look_at(const Numbers &all, const PeriodicBox &box = {})
{
  Result result;
  result.number = all.size();
  for (const auto &a : all) {
    const Vec3 x = {a[c_x], a[c_y], a[c_z]};
    const double r = a[c_radius];
    result.volume += sphere_mass(r, 1.);
    result.order += a[c_id] * (x.x + 2. * x.y + 3. * x.z);
    for (unsigned int d = 0; d < 3; ++d) {
      result.lowest[d] = std::min(result.lowest[d], x[d] - r);
      result.highest[d] = std::max(result.highest[d], x[d] + r);
    }
    for (const auto &b : all)
      if (a[c_id] < b[c_id]) {
        const double sum = r + b[c_radius];
        const double distance = norm(box.shortest(x - Vec3{b[c_x], b[c_y], b[c_z]}));
        result.largest_overlap = std::max(result.largest_overlap, 1. - distance / sum);
      }
  }
  return result;
}

/// The particles at their initial positions.
Numbers pack(const std::string &name, const std::string &input)
{
  return same_on_one_rank(name, [&input](MPI_Comm comm) {
    Numbers particles;
    Case packing(input, comm);
    packing.run([&particles](Simulation &simulation) {
      if (simulation.step_number() == 0)
        particles = particle_table(simulation);
    });
    return particles;
  });
}

void print_fingerprint(const Result &result)
{
  // Recorded, so that a change of the packing is noticed.
  char text[64];
  std::snprintf(text, sizeof text, "fingerprint %.8g", result.order);
  print(text);
}

void test_box()
{
  // 8 mm x 8 mm x 8 mm.
  const Result r = look_at(pack(
      "box",
      case_of_packing(
          500, " set insertion box points coordinates = -4e-3,-4e-3,-9e-3 : 4e-3,4e-3,-1e-3\n")));
  const double fraction = r.volume / std::pow(8e-3, 3);
  check("all have come", r.number == 500);
  check("none overlaps", r.largest_overlap <= 0.);
  check("many nearly touch", r.largest_overlap > -2e-3);
  // The walls of this box lower the attainable solid fraction by several percent.
  check("dense", fraction > 0.52 && fraction < 0.54);
  check("inside the box", r.lowest.x >= -4e-3 - 1e-15 && r.highest.y <= 4e-3 + 1e-15 &&
                              r.lowest.z >= -9e-3 - 1e-15 && r.highest.z <= -1e-3 + 1e-15);
  print_fingerprint(r);
}

void test_periods()
{
  const Numbers all = pack(
      "periodic",
      case_of_packing(
          1900, " set insertion box points coordinates = -1e-2,-1e-2,-1e-2 : 1e-2,1e-2,-5e-3\n",
          "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
          " subsection boundary condition 0\n  set type = periodic\n  set periodic id 0 = 0\n"
          "  set periodic id 1 = 1\n  set periodic direction = 0\n end\nend\n"));
  const Result r = look_at(all, {{2e-2, 0., 0.}, {-1e-2, 0., 0.}});
  check("periodic: none overlaps", r.number == 1900 && r.largest_overlap <= 0.);
  check("periodic: no wall there", r.lowest.x < -1e-2 && r.highest.x > 1e-2);
  check("periodic: walls elsewhere", r.lowest.y >= -1e-2 - 1e-15 && r.highest.y <= 1e-2 + 1e-15);
  print_fingerprint(r);
}

void test_acceptance()
{
  const Numbers all =
      pack("cylinder",
           case_of_packing(
               150, " set insertion box points coordinates = -4e-3,-4e-3,-9e-3 : 4e-3,4e-3,-1e-3\n"
                    " subsection insertion acceptance function\n"
                    "  set Function expression = 2.5e-3^2 - x^2 - y^2\n end\n"));
  check("acceptance function", std::all_of(all.begin(), all.end(), [](const auto &p) {
          return std::hypot(p[c_x], p[c_y]) < 2.5e-3;
        }));
  check("none overlaps there", all.size() == 150 && look_at(all).largest_overlap <= 0.);
}

/// Too many to be packed, but too few to be refused before the packing is tried.
void test_too_many()
{
  Case crowded(case_of_packing(
      570, " set insertion box points coordinates = -4e-3,-4e-3,-9e-3 : 4e-3,4e-3,-1e-3\n"));
  std::string message;
  try {
    crowded.run();
  } catch (const UserError &error) {
    message = error.what();
  }
  check("too many are refused",
        message.find("could not be packed into the box without overlap") != std::string::npos);
}

/// The curved wall of a cylindrical mesh, and a solid within it.
void test_walls_and_solids()
{
  const double half_length = 5e-3, wide = 6e-3;
  const Box block = {{-1e-3, -2e-3, -2e-3}, {1e-3, 2e-3, 2e-3}};
  const Numbers all =
      pack("drum", case_of_packing(1000,
                                   " set insertion box points coordinates = -5e-3,-6e-3,-6e-3 : "
                                   "5e-3,6e-3,6e-3\n",
                                   R"(
    subsection mesh
      set grid type = subdivided_cylinder
      set grid arguments = 2 : 6e-3 : 5e-3
      set initial refinement = 1
    end
    subsection model parameters
      subsection contact detection
        set neighborhood threshold = 1.2
      end
    end
)" + shape_input("box", "-1e-3, -2e-3, -2e-3 : 1e-3, 2e-3, 2e-3")));
  const Result r = look_at(all);
  check("drum: none overlaps another", r.number == 1000 && r.largest_overlap <= 0.);
  bool on_axis = true, in_radius = true, beside = true;
  for (const auto &p : all) {
    const Vec3 x = {p[c_x], p[c_y], p[c_z]};
    on_axis = on_axis && std::abs(x.x) + p[c_radius] <= half_length + 1e-15;
    in_radius = in_radius && std::hypot(x.y, x.z) + p[c_radius] <= wide;
    // Some are in the block, which is hollow.
    Vec3 nearest;
    double to_face = wide;
    for (unsigned int d = 0; d < 3; ++d) {
      nearest[d] = std::min(std::max(x[d], block.lower[d]), block.upper[d]);
      to_face = std::min({to_face, x[d] - block.lower[d], block.upper[d] - x[d]});
    }
    beside = beside && (to_face > 0. ? to_face : norm(x - nearest)) >= p[c_radius];
  }
  check("drum: between its ends", on_axis);
  check("drum: within its side", in_radius);
  check("drum: none overlaps the block", beside);
  print_fingerprint(r);
}

} // namespace

EUNOE_MPI_TEST()
{
  test_box();
  test_periods();
  test_acceptance();
  test_walls_and_solids();
  test_too_many();
}
