// A process that has not done all its work when its bound in time comes ends with an error, so that
// no run looks finished that is not; one that has done it ends well.

#include <eunoe/processes/box_mesh.h>

#include "../tests.h"

using namespace test;

namespace {

constexpr double time_step = 1e-5, bound = 10. * time_step;

/// Is done after it has been called a number of times.
class Counting : public Process
{
public:
  explicit Counting(unsigned int n_steps) : n_steps(n_steps) {}

  void start(Simulation &simulation) override { simulation.insert_and_remove({}, {}); }
  void save(CheckpointWriter &) const override {}
  void resume(Simulation &, const Checkpoint &) override {}
  void step(Simulation &) override { ++n_done; }
  double progress(const Simulation &) const override
  {
    return std::min(1., static_cast<double>(n_done) / n_steps);
  }
  bool finished() const override { return n_done >= n_steps; }

private:
  const unsigned int n_steps;
  unsigned int n_done = 0;
};

template <unsigned int n_steps>
class CountingSection : public ProcessSection
{
public:
  void declare(dealii::ParameterHandler &) override {}
  void check_with(const Parameters &, const ParameterCheck &) const override {}
  void decide(Parameters &parameters) const override
  {
    parameters.mesh = box_mesh("counting", {0., 0., 0.}, {0.01, 0.01, 0.01}, 1e-3, 0.);
    parameters.control.end_control = "time";
    parameters.control.time_end = bound;
  }
  RunEstimate estimate(const Parameters &) const override { return {}; }
  std::unique_ptr<Process> make(const Parameters &) const override
  {
    return std::make_unique<Counting>(n_steps);
  }
};

template <unsigned int n_steps>
std::unique_ptr<ProcessSection> section()
{
  return std::make_unique<CountingSection<n_steps>>();
}

const ProcessRegistry::Registration short_work(process_kinds(), "short work", section<5>),
    long_work(process_kinds(), "long work", section<500>);

/// Steps that a run has made, and with which words it ended.
std::pair<unsigned long long, std::string> outcome(const std::string &process)
{
  Case run("set process = " + process + R"(
subsection simulation control
  set time step     = 1e-5
  set log frequency = 0
  set output path   = results_)" +
           process.substr(0, 4) + R"(
end
subsection lagrangian physical properties
  set g = 0, 0, -9.81
  subsection particle type 0
    set diameter = 1e-3
    set density particles = 1000
  end
end
)");
  std::string words;
  try {
    run.run();
  } catch (const UserError &error) {
    words = error.what();
  }
  return {run->step_number(), words};
}

} // namespace

EUNOE_MPI_TEST()
{
  const auto [few, nothing] = outcome("short work");
  check("done before the bound", few < 10 && nothing.empty(), format_whole(few) + " " + nothing);
  const auto [many, words] = outcome("long work");
  check("not done at the bound",
        many == 10 && words.find("come to its bound of 0.0001 s before all") != std::string::npos,
        format_whole(many) + " " + words);
}
