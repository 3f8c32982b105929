// When a checkpoint is due, what stops a run, which checkpoint is opened when it continues, and
// that none is written over which another run has left in between.

#include <eunoe/checkpoint/checkpoint_file.h>
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
std::size_t n_problems(Checkpoints &checkpoints, unsigned long long n_steps,
                       const std::string &text = input, const std::vector<std::string> &fixed = {},
                       const EntryValues &changed = {})
{
  Log log(MPI_COMM_WORLD, true);
  Problems problems;
  ControlParameters control;
  control.end_control = "iteration";
  control.iteration_end = n_steps;
  control.output_path = folder;
  checkpoints.find(
      values_in(text), changed, {}, control,
      [&fixed](const Problems &differences, const nlohmann::ordered_json &, Problems &found) {
        for (const Problem &difference : differences.all())
          for (const std::string &section : fixed)
            if (difference.where.find(section) == 0)
              found.add(difference.where, difference.what, difference.mend);
      },
      log, problems);
  return problems.all().size();
}

bool is_refused(const Checkpoints &checkpoints)
{
  try {
    checkpoints.check_newest();
  } catch (const UserError &) {
    return true;
  }
  return false;
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
  writer.head["clock"] = Clock(1., 100).save();
  writer.head["clock"]["step"] = 50;
  writer.head["input"] = input;
  const std::string unfinished = folder + "/restart_000000000040.checkpoint.new",
                    not_ours = folder + "/notes.new";
  if (is_first_rank())
    for (const std::string &file : {unfinished, not_ours})
      write_file(file, "half");
  checkpoints.write(writer, 50, log);
  MPI_Barrier(MPI_COMM_WORLD);
  check("what a killed run left unfinished goes",
        !std::filesystem::exists(unfinished) && std::filesystem::exists(not_ours));
  Checkpoints later(may, folder, MPI_COMM_WORLD), too_late(may, folder, MPI_COMM_WORLD);
  check("it is opened", n_problems(later, 100) == 0 && later.opened() != nullptr);
  check("it is behind the end", n_problems(too_late, 49) == 1);
  const std::string other_input = "set a = 2\n";
  Checkpoints strict(may, folder, MPI_COMM_WORLD), phase(need, folder, MPI_COMM_WORLD),
      fixed(need, folder, MPI_COMM_WORLD), no_step(need, folder, MPI_COMM_WORLD);
  check("auto allows no other input", n_problems(strict, 100, other_input) == 1);
  check("true begins a phase", n_problems(phase, 100, other_input) == 0 && phase.begins_phase());
  check("the same input does not", !later.begins_phase() && later.is_own());
  check("some entries must stay", n_problems(fixed, 100, other_input, {"entry 'a'"}) == 1);
  check("a phase has a step at least", n_problems(no_step, 50, other_input) == 1);

  // As an older version of the program may have written it.
  const std::string newer = input + "set b = 3\n";
  Checkpoints standard(may, folder, MPI_COMM_WORLD), set(may, folder, MPI_COMM_WORLD),
      still_own(need, folder, MPI_COMM_WORLD);
  check("a new entry at its default is no difference", n_problems(standard, 100, newer) == 0 &&
                                                           n_problems(still_own, 100, newer) == 0 &&
                                                           !still_own.begins_phase());
  check("one that is set is", n_problems(set, 100, newer, {}, {{{{}, "b"}, "3"}}) == 1);

  const std::string elsewhere = "checkpoints_of_other_run";
  RestartParameters guest = parameters("auto");
  guest.folder = folder;
  create_folder(elsewhere, MPI_COMM_WORLD);
  Checkpoints of_other(guest, elsewhere, MPI_COMM_WORLD);
  check("that of another run", n_problems(of_other, 100, other_input) == 0 &&
                                   of_other.begins_phase() && !of_other.is_own());

  std::string message;
  try {
    later.understand([](const nlohmann::ordered_json &head) { head.at("nothing"); });
  } catch (const UserError &error) {
    message = error.what();
  }
  check("what it lacks is said", message.find("lacks what the case needs") != std::string::npos);

  check("no other run went on", !is_refused(later) && !is_refused(of_other));
  check("another run began here", is_refused(perhaps));
  if (is_first_rank())
    write_file(folder + "/restart.latest",
               "restart_000000000060.checkpoint\nrestart_000000000050.checkpoint\n");
  check("another run went on", is_refused(later) && !is_refused(of_other));
  check("a run that begins anew does not mind", !is_refused(checkpoints));

  const std::string emptied = "checkpoints_taken_away";
  create_folder(emptied, MPI_COMM_WORLD);
  if (is_first_rank())
    write_file(emptied + "/restart.latest", "restart_000000000060.checkpoint\n");
  MPI_Barrier(MPI_COMM_WORLD);
  CheckpointStore store(emptied, "restart", 2, MPI_COMM_WORLD);
  store.begin_anew();
  std::vector<std::string> defects;
  check("a list of none goes with a new run",
        store.open_newest(defects) == nullptr && defects.empty());
}
