#include "tests.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

namespace test {

namespace {

std::unique_ptr<Simulation> opened(const std::string &input, MPI_Comm comm, Log &log)
{
  Problems problems;
  const Parameters parameters = Parameters::read(input, "test.prm", {}, problems);
  if (!problems.empty())
    throw UserError(problems);
  auto simulation = std::make_unique<Simulation>(parameters, comm, log);
  simulation->open_output();
  return simulation;
}

} // namespace

bool is_first_rank()
{
  int initialized = 0, rank = 0;
  MPI_Initialized(&initialized);
  if (initialized != 0)
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

void print(const std::string &line)
{
  if (is_first_rank())
    std::cout << line << std::endl;
}

void check(const std::string &name, bool ok, const std::string &otherwise)
{
  print(name + ": " + (ok ? "ok" : otherwise));
}

void check_close(const std::string &name, double value, double reference, double tolerance)
{
  char text[160];
  std::snprintf(text, sizeof text, "%.12g instead of %.12g, off by %.3g, allowed %.3g", value,
                reference, value - reference, tolerance);
  check(name, std::abs(value - reference) <= tolerance, text);
}

void check_relative(const std::string &name, double value, double reference, double tolerance)
{
  check_close(name, value, reference, tolerance * std::abs(reference));
}

std::vector<std::vector<double>> particle_table(Simulation &simulation)
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

std::string box_input(double time_step, double time_end, const std::string &more)
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

std::string shape_input(const std::string &shape, const std::string &arguments,
                        const std::string &more)
{
  return "subsection solid objects\n subsection solid surfaces\n set number of solids = 1\n"
         " subsection solid object 0\n subsection mesh\n set type = shape\n set grid type = " +
         shape + "\n set grid arguments = " + arguments + "\n end\n" + more + " end\n end\nend\n";
}

std::vector<std::vector<double>> particles_when(
    Simulation &simulation, const std::function<bool(const Simulation &)> &condition)
{
  struct Seen
  {
  };
  std::vector<std::vector<double>> table;
  try {
    simulation.run([&](Simulation &) {
      if (!condition(simulation))
        return;
      table = particle_table(simulation);
      throw Seen();
    });
  } catch (const Seen &) {
  }
  return table;
}

std::vector<std::vector<double>> of_all_ranks(MPI_Comm comm,
                                              const std::vector<std::vector<double>> &mine)
{
  std::vector<std::vector<double>> all;
  for (const auto &part : dealii::Utilities::MPI::all_gather(comm, mine))
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

void read_entries(const std::function<void(dealii::ParameterHandler &)> &declare,
                  const std::string &written)
{
  dealii::ParameterHandler prm;
  declare(prm);
  prm.parse_input_from_string(written);
}

Case::Case(const std::string &input, MPI_Comm comm)
    : log(comm, true), simulation(opened(input, comm, log))
{
}

Case::~Case() = default;

void Case::run(const std::function<void(Simulation &)> &look)
{
  simulation->run(look);
}

} // namespace test
