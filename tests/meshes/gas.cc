// Elastic spheres fly in meshes of every shape: none is lost, the energy is conserved, and the bits
// are the same on any number of ranks, whatever the shape of the mesh cells.

#include <eunoe/core/random.h>

#include "meshes.h"

using namespace test;

namespace {

using Table = std::vector<std::vector<double>>;

/// Spheres at random places in a shape, without overlap and all with the same speed.
std::string spheres_in(const std::function<bool(const Vec3 &)> &holds, const Vec3 &lower,
                       const Vec3 &upper, double diameter, std::size_t n)
{
  std::vector<Vec3> positions, velocities;
  const auto draw = [&](std::uint64_t k, unsigned int d) { return uniform(7, Draw::offset, k, d); };
  for (std::uint64_t k = 0; positions.size() < n && k < 100000; ++k) {
    Vec3 x, v;
    for (unsigned int d = 0; d < 3; ++d) {
      x[d] = lower[d] + draw(k, d) * (upper[d] - lower[d]);
      v[d] = draw(k + 200000, d) - 0.5;
    }
    if (holds(x) && std::all_of(positions.begin(), positions.end(),
                                [&](const Vec3 &y) { return norm(x - y) > diameter; }))
    {
      positions.push_back(x);
      velocities.push_back(v / norm(v));
    }
  }
  return places(positions, velocities);
}

double kinetic_energy(const Table &table)
{
  double sum = 0.;
  for (const auto &row : table)
    sum += row[c_vx] * row[c_vx] + row[c_vy] * row[c_vy] + row[c_vz] * row[c_vz];
  return sum;
}

void fly(const std::string &name, const std::string &mesh, const std::string &spheres,
         double diameter, std::size_t n, const std::string &more = "")
{
  const auto result_of = [&](MPI_Comm comm) {
    Case test_case(control(4e-6, 0.02) + mesh + powder(diameter, 1., 0., "0, 0, 0") +
                       "subsection model parameters\n subsection load balancing\n"
                       "  set load balance method = frequent\n  set frequency = 500\n end\nend\n" +
                       spheres + more,
                   comm);
    test_case.run();
    return particle_table(*test_case);
  };
  const Table table = run_alone_and_together<Table>(name, result_of);
  check(name + ": all are there", table.size() == n);
  // The elastic energy of spheres that are in contact at the end is missing.
  check_relative(name + ": energy", kinetic_energy(table), static_cast<double>(n), 0.03);
}

} // namespace

EUNOE_MPI_TEST()
{
  const double d = 0.5e-3;
  const Vec3 lower = {-8e-3, -8e-3, -8e-3}, upper = -lower;
  const auto in_ball = [](const Vec3 &x) { return norm(x) < 8e-3; };
  const auto in_cylinder = [](const Vec3 &x) { return std::hypot(x.y, x.z) < 8e-3; };
  const auto in_cone = [](const Vec3 &x) { return std::hypot(x.y, x.z) < 5e-3; };
  const auto in_shell = [](const Vec3 &x) { return norm(x) < 8e-3 && norm(x) > 5e-3; };
  const std::string cylinder = generated_mesh("subdivided_cylinder", "2 : 10e-3 : 10e-3", 2);

  fly("ball", generated_mesh("hyper_ball", "0, 0, 0 : 10e-3 : true", 2),
      spheres_in(in_ball, lower, upper, d, 300), d, 300);
  fly("cylinder", cylinder, spheres_in(in_cylinder, lower, upper, d, 300), d, 300);
  fly("periodic cylinder", cylinder, spheres_in(in_cylinder, lower, upper, d, 300), d, 300,
      "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
      " subsection boundary condition 0\n  set type = periodic\n  set periodic id 0 = 1\n"
      "  set periodic id 1 = 2\n  set periodic direction = 0\n end\nend\n");
  for (const std::string kind : {"balanced", "squared", "regularized"})
    fly("Lethe's " + kind + " cylinder",
        generated_mesh("cylinder_" + kind, "4 : 10e-3 : 10e-3", kind == "regularized" ? 0 : 2,
                       " set type = lethe\n"),
        spheres_in(in_cylinder, lower, upper, d, 300), d, 300);
  fly("cone", generated_mesh("truncated_cone", "10e-3 : 6e-3 : 10e-3", 2),
      spheres_in(in_cone, lower, upper, d, 300), d, 300);
  fly("shell between balls", generated_mesh("hyper_shell", "0, 0, 0 : 4e-3 : 12e-3 : 6 : true", 2),
      spheres_in(in_shell, lower, upper, d, 300), d, 300);
  // A mesh that is finer in a corner, with hanging nodes on the curved wall.
  fly("refined cylinder",
      generated_mesh("subdivided_cylinder", "2 : 10e-3 : 10e-3", 1) +
          refinement({"0, 0, 0 : 20e-3, 20e-3, 20e-3"}),
      spheres_in(in_cylinder, lower, upper, d, 300), d, 300);
}
