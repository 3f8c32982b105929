// The step that `time step = auto` gives, beside numbers worked out by hand from the radius R,
// density rho, Young's modulus Y and Poisson's ratio nu of the grains:
//   T_R = pi R sqrt(2 (1 + nu) rho / Y) / (0.1631 nu + 0.8766),
//   T_c = pi sqrt(m*/k), k = 2 Y* sqrt(R* 0.01 R) with Hertz's force,
// both proportional to R sqrt(rho / Y).

#include "../tests.h"

using namespace test;

namespace {

const std::string properties = "lagrangian physical properties/",
                  type_0 = properties + "particle type 0/",
                  type_1 = properties + "particle type 1/", control = "simulation control/";

/// The step (s) of grains of 1 mm, 2500 kg/m3, 100 MPa and 0.3, in a box of the same material.
double step_with(std::vector<std::string> settings)
{
  settings.insert(settings.begin(),
                  {control + "time step = auto", type_0 + "diameter = 1e-3", type_0 + "number = 1",
                   type_0 + "density particles = 2500", type_0 + "young modulus particles = 1e8",
                   type_0 + "poisson ratio particles = 0.3",
                   properties + "young modulus wall = 1e8",
                   properties + "poisson ratio wall = 0.3"});
  Problems problems;
  const Parameters parameters =
      Parameters::read(box_input(1e-6, 1e-5, ""), "case.prm", settings, problems);
  if (!problems.empty())
    throw UserError(problems);
  return parameters.control.time_step;
}

/// As above, with grains of a second type, of 0.4 mm and 400 MPa, whose T_R is a fifth.
double step_with_smaller(const std::string &number)
{
  return step_with({properties + "number of particle types = 2", type_1 + "diameter = 4e-4",
                    type_1 + "number = " + number, type_1 + "density particles = 2500",
                    type_1 + "young modulus particles = 4e8",
                    type_1 + "poisson ratio particles = 0.3"});
}

} // namespace

EUNOE_MPI_TEST()
{
  constexpr double rayleigh_time = 1.3683149e-5, digits = 1e-7;
  check_relative("a fifth of the Rayleigh time", step_with({}), 0.2 * rayleigh_time, digits);
  check_relative("another share", step_with({control + "time step share = 0.1"}),
                 0.1 * rayleigh_time, digits);

  check_relative("of the smallest and stiffest type", step_with_smaller("1"), 0.04 * rayleigh_time,
                 digits);
  check_relative("but of one of which there are grains", step_with_smaller("0"),
                 0.2 * rayleigh_time, digits);
  check_relative("of the smallest class",
                 step_with({type_0 + "size distribution type = custom",
                            type_0 + "custom distribution diameters values = 1e-3, 5e-4",
                            type_0 + "custom distribution diameters probabilities = 0.9, 0.1"}),
                 0.1 * rayleigh_time, digits);
  check_relative(
      "of the smallest diameter of a normal distribution, 2.5 deviations below the mean",
      step_with({type_0 + "size distribution type = normal", type_0 + "standard deviation = 1e-4"}),
      0.15 * rayleigh_time, digits);

  // A rigid wall: m* = 1.3089969e-6 kg, Y* = 1.0989011e8 Pa, k = 1.0989011e4 N/m.
  const std::string rigid = properties + "young modulus wall = 1e16";
  check_relative("a tenth of the contact with a rigid wall",
                 step_with({rigid, control + "time step share = 0.5"}), 3.4287821e-6, digits);
  check_relative("which is longer than a fifth of the Rayleigh time", step_with({rigid}),
                 0.2 * rayleigh_time, digits);
  // Grains of 0.1 MPa with the linear law, where a fifth of T_R is 8.65e-5 s. Two of them:
  // m* = 6.5449847e-7 kg, s = 16/15 sqrt(R*) Y* = 926.6748, k = s (m*/s)^(1/5).
  check_relative(
      "a tenth of the contact of two soft grains with the linear law",
      step_with({type_0 + "young modulus particles = 1e5", properties + "young modulus wall = 1e5",
                 "model parameters/particle particle contact force method = linear",
                 "model parameters/particle wall contact force method = linear"}),
      6.8666101e-5, digits);
}
