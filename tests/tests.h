#ifndef eunoe_tests_h
#define eunoe_tests_h

// What all tests share. A test prints one line a check, "name: ok" or what is wrong; its .output
// file holds the lines of success. Numbers are compared here, with their own tolerances, as the
// comparison of whole files knows neither units nor references.

#include <eunoe/simulation/simulation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <string>

namespace test {

using namespace eunoe;

inline bool is_first_rank()
{
  int initialized = 0, rank = 0;
  MPI_Initialized(&initialized);
  if (initialized != 0)
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

/// Prints a line on the first rank.
inline void print(const std::string &line)
{
  if (is_first_rank())
    std::cout << line << std::endl;
}

inline void check(const std::string &name, bool ok, const std::string &otherwise = "is not so")
{
  print(name + ": " + (ok ? "ok" : otherwise));
}

/// Whether a value agrees with its reference to an absolute tolerance.
inline void check_close(const std::string &name, double value, double reference, double tolerance)
{
  char text[160];
  std::snprintf(text, sizeof text, "%.12g instead of %.12g, off by %.3g, allowed %.3g", value,
                reference, value - reference, tolerance);
  check(name, std::abs(value - reference) <= tolerance, text);
}

/// Whether a value agrees with its reference to a relative tolerance.
inline void check_relative(const std::string &name, double value, double reference,
                           double tolerance)
{
  check_close(name, value, reference, tolerance * std::abs(reference));
}

/// The rows of all ranks, those of the first rank first; the same on every rank.
std::vector<std::vector<double>> of_all_ranks(MPI_Comm comm,
                                              const std::vector<std::vector<double>> &mine);

/// The test that a file holds, under the name of the file. All tests of a folder are linked to one
/// program, which runs the one that it is asked for (tests/program.cc).
class Registration
{
public:
  Registration(const char *file, void (*test)(), bool with_mpi);
};

/// What stands in the place of main(), for a test without MPI and for one with it.
#define EUNOE_TEST() EUNOE_TEST_WITH_MPI(false)
#define EUNOE_MPI_TEST() EUNOE_TEST_WITH_MPI(true)
#define EUNOE_TEST_WITH_MPI(with_mpi)                                                              \
  static void the_test();                                                                          \
  static const test::Registration the_registration(__FILE__, the_test, with_mpi);                  \
  static void the_test()

/// A case that a test runs in its own process: an input text, run quietly, with a look after every
/// step.
class Case
{
public:
  explicit Case(const std::string &input, MPI_Comm comm = MPI_COMM_WORLD) : log(comm, true)
  {
    Problems problems;
    parameters = Parameters::read(input, "test.prm", {}, problems);
    if (!problems.empty())
      throw UserError(problems);
    simulation = std::make_unique<Simulation>(parameters, comm, log);
    simulation->open_output();
  }

  /// Runs to the end.
  /// @param look called before the first step and after every step
  void run(const std::function<void(Simulation &)> &look = {}) { simulation->run(look); }

  Simulation &operator*() { return *simulation; }
  Simulation *operator->() { return simulation.get(); }

private:
  Log log;
  Parameters parameters;
  std::unique_ptr<Simulation> simulation;
};

/// What a particle is and does, in the order of `particle_table`.
enum Column
{
  c_id,
  c_x,
  c_y,
  c_z,
  c_radius,
  c_vx,
  c_vy,
  c_vz,
  c_wx,
  c_wy,
  c_wz
};

/// One row a particle of all ranks, by id; the same on every rank. SI units.
inline std::vector<std::vector<double>> particle_table(Simulation &simulation)
{
  const ParticleArrays &p = simulation.complete_step();
  std::vector<std::vector<double>> mine;
  for (std::size_t k = 0; k < p.n_owned; ++k) {
    const Quad &x = p.position[k], &v = p.velocity[k], &w = p.spin[k];
    mine.push_back(
        {static_cast<double>(p.id[k]), x.x, x.y, x.z, p.radius(k), v.x, v.y, v.z, w.x, w.y, w.z});
  }
  std::vector<std::vector<double>> all = of_all_ranks(simulation.communicator(), mine);
  std::sort(all.begin(), all.end());
  return all;
}

/// An input text for spheres without gravity in a periodic-free box from -1 to 1 cm whose walls
/// are far away; entries are added behind it. Material: young 1e6 Pa, poisson 0.3, rho 1000.
inline std::string box_input(double time_step, double time_end, const std::string &more)
{
  char head[512];
  std::snprintf(head, sizeof head,
                "subsection simulation control\n set time step = %.17g\n set time end = %.17g\n"
                " set log frequency = 0\n set output path = results\nend\n"
                "subsection mesh\n set grid type = subdivided_hyper_rectangle\n"
                " set grid arguments = 4, 4, 4 : -0.01, -0.01, -0.01 : 0.01, 0.01, 0.01 : true\n"
                "end\n",
                time_step, time_end);
  return head + more;
}

/// A solid from a shape, at rest unless told otherwise.
/// @param more entries of the solid
inline std::string shape_input(const std::string &shape, const std::string &arguments,
                               const std::string &more = "")
{
  return "subsection solid objects\n subsection solid surfaces\n set number of solids = 1\n"
         " subsection solid object 0\n subsection mesh\n set type = shape\n set grid type = " +
         shape + "\n set grid arguments = " + arguments + "\n end\n" + more + " end\n end\nend\n";
}

} // namespace test

#endif
