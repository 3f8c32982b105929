#include <eunoe/checkpoint/head_values.h>
#include <eunoe/checkpoint/input_differences.h>
#include <eunoe/core/log.h>
#include <eunoe/core/stop_request.h>
#include <eunoe/simulation/checkpoints.h>

namespace eunoe {

void Checkpoints::find(const std::string &input, const unsigned long long n_steps, Log &log,
                       Problems &problems)
{
  if (parameters.restart == "false")
    return;
  std::vector<std::string> defects;
  checkpoint = store.open_newest(defects);
  if (!checkpoint) {
    if (parameters.restart == "true")
      problems.add("subsection 'restart' / entry 'restart'",
                   "is true, but " + folder + " holds no checkpoint '" + parameters.filename + "'.",
                   "Check 'output path' and 'filename', or set restart = auto to start anew where "
                   "there is none.");
    return;
  }
  for (const std::string &defect : defects)
    log.warning(defect);
  const nlohmann::ordered_json &head = checkpoint->head;
  if (!head.contains("input") || !head["input"].is_string())
    throw checkpoint->damaged("it does not hold the input of its run.");
  find_input_differences(input, head["input"], checkpoint->path, problems);
  understand([&](const nlohmann::ordered_json &of_run) {
    const auto step = count_in(of_run.at("clock").at("step"));
    if (step > n_steps)
      problems.add("The checkpoint " + checkpoint->path,
                   "is of step " + std::to_string(step) + ", and the run ends at step " +
                       std::to_string(n_steps) + ".",
                   "Raise 'time end' or 'iteration end', or start anew with 'restart = false'.");
  });
}

void Checkpoints::understand(
    const std::function<void(const nlohmann::ordered_json &)> &action) const
{
  try {
    action(checkpoint->head);
  } catch (const nlohmann::json::exception &) {
    throw checkpoint->damaged("its head lacks what the case needs.");
  } catch (const std::invalid_argument &) {
    throw checkpoint->damaged("a number in its head is none.");
  }
}

void Checkpoints::begin()
{
  if (parameters.checkpoint)
    stop_request::listen();
  last_time = MPI_Wtime();
}

bool Checkpoints::is_due(const unsigned long long step)
{
  const RestartParameters &p = parameters;
  if (!p.checkpoint)
    return false;
  // All ranks must agree on what only some know: the clock of the first, and signals.
  constexpr unsigned int steps_between_looks = 16;
  int wish[2] = {0, 0};
  if (step % steps_between_looks == 0) {
    wish[0] = stop_request::received();
    wish[1] = p.minutes > 0. && MPI_Wtime() - last_time > 60. * p.minutes ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, wish, 2, MPI_INT, MPI_MAX, comm);
  }
  signal = wish[0];
  return wish[1] != 0 || signal != 0 || (p.frequency > 0 && step % p.frequency == 0);
}

void Checkpoints::write(CheckpointWriter &writer, const unsigned long long step, Log &log)
{
  const std::string path = store.write(writer, step);
  last_time = MPI_Wtime();
  if (signal != 0)
    log.line("Asked to stop by signal " + std::to_string(signal) + " at step " +
             std::to_string(step) + ". The run continues from " + path +
             " with 'restart = true' in subsection 'restart'.");
}

} // namespace eunoe
