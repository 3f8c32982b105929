#include <eunoe/core/declare.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/simulation/control_parameters.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe {

namespace {
const std::string section = "simulation control";
} // namespace

void ControlParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, section);
  declare::number_or_word(
      prm, "time step", "auto", format(*given_time_step), 0., std::numeric_limits<double>::max(),
      "Time step (s). 'auto': 'time step share' of the Rayleigh time of the smallest particle, and "
      "at most a tenth of the stiffest contact's time.",
      [this](const std::optional<double> &value) {
        given_time_step = value;
        time_step = value.value_or(time_step);
      });
  declare::between(prm, "time step share", rayleigh_share, 0., 1.,
                   "Share of the Rayleigh time that 'time step = auto' takes.");
  declare::choice(prm, "end control", end_control, "time|iteration",
                  "Whether 'time end' or 'iteration end' ends the run. A process may end it "
                  "earlier, when all its work is done.");
  declare::not_negative(prm, "time end", time_end, "Simulated time at which the run ends (s).");
  declare::count(prm, "iteration end", iteration_end, "Number of steps of the run.");
  declare::entry(prm, "output path", output_path, "Folder of all results; created if missing.");
  declare::entry(prm, "output name", output_name,
                 "Beginning of the names of the .pvd and .vtu files.");
  declare::choice(prm, "output control", output_control, "iteration|time",
                  "Whether 'output frequency' or 'output time' rules the files for pictures.");
  declare::count(prm, "output frequency", output_frequency,
                 "Steps between files for pictures; 0: none.");
  declare::not_negative(prm, "output time", output_time,
                        "Simulated time between files for pictures (s).");
  declare::list(prm, "output time interval", output_window, {2, 2},
                "Simulated times between which files for pictures are written (s).");
  declare::count(prm, "log frequency", log_frequency,
                 "Steps between lines of a log that is not on a terminal; 0: none.");
  declare::count(prm, "seed", seed,
                 "Seed of all random numbers, in the place of every other entry for a seed; -1: "
                 "each entry's own. The option --seed gives it, too.",
                 -1);
  declare::leave(prm);
}

void ControlParameters::check(const ParameterCheck &check) const
{
  check.require(time_step > 0., {section}, "time step", "is " + format(time_step) + " s.",
                "Give a positive time step, about 15 % of the Rayleigh time, or 'auto'.");
  check.require(rayleigh_share > 0., {section}, "time step share", "is 0.",
                "Give a positive share, such as 0.2.");
  check.require(output_control != "time" || output_time > 0., {section}, "output time",
                "is " + format(output_time) + " s.", "Give a positive interval.");
  check.require(end_control != "iteration" || iteration_end > 0, {section}, "iteration end",
                "is 0 while 'end control' is 'iteration'.", "Give the number of steps.");
  check.require(output_name.find('/') == std::string::npos && !output_name.empty(), {section},
                "output name", "is '" + shortened(output_name) + "'.",
                "Give a name without '/'; the folder belongs into 'output path'.");
  check.require(!output_path.empty(), {section}, "output path", "is empty.",
                "Name the folder of the results, '.' for the present one.");
  check.require(output_window[0] <= output_window[1], {section}, "output time interval",
                "ends at " + format(output_window[1]) + " s, before it begins at " +
                    format(output_window[0]) + " s.",
                "Give the beginning first.");
}

unsigned long long ControlParameters::n_steps() const
{
  return last_step(0, 0.);
}

unsigned long long ControlParameters::last_step(const unsigned long long step,
                                                const double time) const
{
  // No run does more steps than this, and it is the same number as a double.
  constexpr double most = 0x1p63;
  const double steps = std::min((time_end - time) / time_step, 2. * most);
  return end_control == "iteration"
             ? iteration_end
             : step + static_cast<unsigned long long>(
                          std::clamp(std::ceil(steps - 1e-9 * std::max(1., steps)), 0., most));
}

} // namespace eunoe
