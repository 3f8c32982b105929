#ifndef eunoe_engine_clock_h
#define eunoe_engine_clock_h

#include <nlohmann/json_fwd.hpp>

#include <functional>

namespace eunoe {

/// The steps of a run and the time that they make.
class Clock
{
public:
  /// @param time_step (s)
  /// @param n_steps of the whole run
  Clock(double time_step, unsigned long long n_steps) : dt(time_step), last(n_steps) {}

  void advance() { ++present; }

  unsigned long long step() const { return present; }
  double time() const { return begin_time + static_cast<double>(present - begin_step) * dt; }
  double time_step() const { return dt; }
  /// Whether the last step is done.
  bool is_at_end() const { return present >= last; }
  /// Share of the steps that are done.
  double share() const { return static_cast<double>(present) / static_cast<double>(last); }
  /// At which this part of the run began.
  unsigned long long first_step() const { return first; }

  /// The step at which a run ends, of those that are done at a time (s) and those of the present
  /// time step.
  using End = std::function<unsigned long long(unsigned long long step, double time)>;

  nlohmann::ordered_json save() const;
  /// Goes on at a step that was saved.
  void load(const nlohmann::ordered_json &saved, const End &end);
  /// Goes on at a step that was saved by a run with another time step or another end.
  void begin_phase(const nlohmann::ordered_json &saved, const End &end);

private:
  const double dt;
  unsigned long long last;
  unsigned long long present = 0, first = 0;
  unsigned long long begin_step = 0; ///< since which all steps are as long as now
  double begin_time = 0.;            ///< of that step (s)
};

} // namespace eunoe

#endif
