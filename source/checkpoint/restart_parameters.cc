#include <eunoe/checkpoint/restart_parameters.h>
#include <eunoe/core/declare.h>
#include <eunoe/core/quoted_text.h>

namespace eunoe {

namespace {
const std::string section = "restart";
} // namespace

void RestartParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, section);
  declare::entry(
      prm, "checkpoint", checkpoint,
      "Whether checkpoints are written: at intervals, at the end, and when the run is asked to "
      "stop (SIGTERM, SIGINT, SIGUSR1); it then ends with exit code 3. Send SIGUSR1 to Open MPI's "
      "mpirun: after SIGTERM or SIGINT it kills the processes within seconds, before a large run "
      "has written.");
  declare::count(prm, "frequency", frequency, "Steps between checkpoints; 0: by the clock alone.");
  declare::not_negative(prm, "wall time interval", minutes,
                        "Minutes of wall-clock time between checkpoints; 0: by steps alone.");
  declare::count(prm, "number of checkpoints", keep, "Number of checkpoints that stay.", 1);
  declare::entry(
      prm, "filename", filename,
      "Beginning of the names of the checkpoints in the output folder, or, with a '/', of "
      "their paths.");
  declare::choice(prm, "restart", restart, "false|true|auto",
                  "Whether the run continues from the last checkpoint; auto: if there is one. With "
                  "true, the input may differ from that of the checkpoint: the run goes on with "
                  "what it says now.");
  declare::entry(
      prm, "restart folder", folder,
      "Output folder of another run, from whose last checkpoint this one goes on as long "
      "as it has none of its own. Empty: with 'restart = true', the only folder beside "
      "the output folder or in the present one that holds such a checkpoint.");
  declare::leave(prm);
}

void RestartParameters::check(const ParameterCheck &check) const
{
  check.require(!name().empty(), {section}, "filename", "is '" + shortened(filename) + "'.",
                "Give a name, or a path that ends with one.");
}

} // namespace eunoe
