#ifndef eunoe_tests_h
#define eunoe_tests_h

// What all tests share. A test prints one line for each check, "name: ok" or what is wrong; its
// .output file holds the lines of success. Numbers are compared in the tests, with their own
// tolerances, as the comparison of whole files knows neither units nor references.

#include <eunoe/simulation/simulation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <string>

namespace dealii {
class ParameterHandler;
}

namespace test {

using namespace eunoe;

bool is_first_rank();

/// Prints a line on the first rank.
void print(const std::string &line);

void check(const std::string &name, bool ok, const std::string &otherwise = "is not so");

/// Whether a value agrees with its reference to an absolute tolerance.
void check_close(const std::string &name, double value, double reference, double tolerance);

/// Whether a value agrees with its reference to a relative tolerance.
void check_relative(const std::string &name, double value, double reference, double tolerance);

/// The rows of all ranks, those of the first rank first; the same on every rank.
std::vector<std::vector<double>> of_all_ranks(MPI_Comm comm,
                                              const std::vector<std::vector<double>> &mine);

/// Declares entries and reads their values from the text @p written.
void read_entries(const std::function<void(dealii::ParameterHandler &)> &declare,
                  const std::string &written);

/// Registers the test of a file under the name of the file. All tests of a folder are linked into
/// one program, which runs the test named on its command line (tests/program.cc).
class Registration
{
public:
  Registration(const char *file, void (*test)(), bool with_mpi);
};

/// These replace main(), for a test without MPI and for one with it.
#define EUNOE_TEST() EUNOE_TEST_WITH_MPI(false)
#define EUNOE_MPI_TEST() EUNOE_TEST_WITH_MPI(true)
#define EUNOE_TEST_WITH_MPI(with_mpi)                                                              \
  static void the_test();                                                                          \
  static const test::Registration the_registration(__FILE__, the_test, with_mpi);                  \
  static void the_test()

/// A case that a test runs in its own process: an input text, run quietly; the test can look at the
/// state after every step.
class Case
{
public:
  explicit Case(const std::string &input, MPI_Comm comm = MPI_COMM_WORLD);
  ~Case();

  /// Runs to the end.
  /// @param look called before the first step and after every step
  void run(const std::function<void(Simulation &)> &look = {});

  Simulation &operator*() { return *simulation; }
  Simulation *operator->() { return simulation.get(); }

private:
  Log log;
  const std::unique_ptr<Simulation> simulation;
};

/// Columns of `particle_table`.
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

/// One row for each particle of all ranks, sorted by id; the same on every rank. SI units.
std::vector<std::vector<double>> particle_table(Simulation &simulation);

/// Runs until a condition holds after a step, and returns the particles at that time; an empty
/// table if it never holds.
std::vector<std::vector<double>> particles_when(
    Simulation &simulation, const std::function<bool(const Simulation &)> &condition);

/// An input text for spheres without gravity in a box from -1 to 1 cm, without periodic boundaries
/// and with its walls far away; @p more is appended. Young's modulus 1e6 Pa, Poisson's ratio 0.3,
/// density 1000 kg/m3.
std::string box_input(double time_step, double time_end, const std::string &more);

/// A solid from a shape, at rest unless told otherwise.
/// @param more entries of the solid
std::string shape_input(const std::string &shape, const std::string &arguments,
                        const std::string &more = "");

} // namespace test

#endif
