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
  declare::entry(prm, "checkpoint", checkpoint,
                 "Whether checkpoints are written: at intervals, and when the run is asked to "
                 "stop (SIGTERM, SIGINT, SIGUSR1); it then ends with exit code 3.");
  declare::count(prm, "frequency", frequency, "Steps between checkpoints; 0: by the clock alone.");
  declare::not_negative(prm, "wall time interval", minutes,
                        "Minutes of wall-clock time between checkpoints; 0: by steps alone.");
  declare::count(prm, "number of checkpoints", keep, "Number of checkpoints that stay.", 1);
  declare::entry(prm, "filename", filename,
                 "Beginning of the names of the checkpoints in the output folder.");
  declare::choice(prm, "restart", restart, "false|true|auto",
                  "Whether the run continues from the last checkpoint; auto: if there is one.");
  declare::leave(prm);
}

void RestartParameters::check(const ParameterCheck &check) const
{
  check.require(!filename.empty() && filename.find('/') == std::string::npos, {section}, "filename",
                "is '" + shortened(filename) + "'.", "Give a name without '/'.");
}

} // namespace eunoe
