// When a checkpoint is due, what stops a run, and which checkpoint is opened when it continues.

#include <eunoe/core/files.h>
#include <eunoe/simulation/checkpoints.h>

#include "../tests.h"

#include <csignal>
#include <filesystem>

using namespace test;

namespace {

const std::string folder = "checkpoints_of_test";
const std::string input = "set a = 1\n";

RestartParameters parameters(const std::string &restart)
{
  RestartParameters p;
  p.checkpoint = true;
  p.minutes = 0.;
  p.restart = restart;
  return p;
}

/// Number of problems at the start of a run of so many steps.
std::size_t n_problems(Checkpoints &checkpoints, unsigned long long n_steps)
{
  Log log(MPI_COMM_WORLD, true);
  Problems problems;
  checkpoints.find(input, n_steps, log, problems);
  return problems.all().size();
}

} // namespace

EUNOE_MPI_TEST()
{
  Log log(MPI_COMM_WORLD, true);
  if (is_first_rank())
    std::filesystem::remove_all(folder);
  create_folder(folder, MPI_COMM_WORLD);

  RestartParameters p = parameters("false");
  p.frequency = 7;
  Checkpoints checkpoints(p, folder, MPI_COMM_WORLD);
  checkpoints.begin();
  check("every seven steps",
        checkpoints.is_due(7) && !checkpoints.is_due(8) && checkpoints.is_due(14));
  p.frequency = 0;
  check("no more by steps", !checkpoints.is_due(7) && !checkpoints.is_due(16));
  p.minutes = 1e-9;
  check("by the clock, looked at rarely", !checkpoints.is_due(15) && checkpoints.is_due(16));
  p.minutes = 0.;
  // A signal to one of the ranks is enough.
  if (is_first_rank())
    std::raise(SIGUSR1);
  MPI_Barrier(MPI_COMM_WORLD);
  check("not stopped between looks", !checkpoints.is_due(31) && !checkpoints.is_stopped());
  check("stopped at a look", checkpoints.is_due(32) && checkpoints.is_stopped());
  p.checkpoint = false;
  check("never", !checkpoints.is_due(32));

  const RestartParameters need = parameters("true"), may = parameters("auto");
  Checkpoints needed(need, folder, MPI_COMM_WORLD), perhaps(may, folder, MPI_COMM_WORLD);
  check("there must be one", n_problems(needed, 100) == 1);
  check("there may be none", n_problems(perhaps, 100) == 0 && perhaps.opened() == nullptr);

  CheckpointWriter writer(MPI_COMM_WORLD);
  writer.add_rows("particles", {}, {});
  writer.head["clock"]["step"] = 50;
  writer.head["input"] = input;
  checkpoints.write(writer, 50, log);
  Checkpoints later(may, folder, MPI_COMM_WORLD), too_late(may, folder, MPI_COMM_WORLD);
  check("it is opened", n_problems(later, 100) == 0 && later.opened() != nullptr);
  check("it is behind the end", n_problems(too_late, 49) == 1);
  std::string message;
  try {
    later.understand([](const nlohmann::ordered_json &head) { head.at("nothing"); });
  } catch (const UserError &error) {
    message = error.what();
  }
  check("what it lacks is said", message.find("lacks what the case needs") != std::string::npos);
}
