#ifndef eunoe_simulation_progress_h
#define eunoe_simulation_progress_h

#include <eunoe/core/log.h>
#include <eunoe/core/timers.h>
#include <eunoe/engine/clock.h>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace eunoe {

/// How far and how fast a run has come, and what takes its time.
class Progress
{
public:
  /// @param log_frequency steps between two lines in the log; 0: none
  Progress(Log &log, unsigned long long log_frequency)
      : log(log), log_frequency(log_frequency), start_of_run(MPI_Wtime())
  {
  }

  /// Of the loop, once it has begun.
  Timers timers;
  Log &get_log() const { return log; }

  void begin_loop();
  void end_loop() { loop_seconds = MPI_Wtime() - start_of_loop; }

  /// Counts the work of a step.
  /// @param n_particles of all ranks
  /// @param n_asleep of this rank
  void count_step(std::uint64_t n_particles, std::size_t n_asleep);

  /// Whether the user is to be told how far the run is.
  bool is_report_due(unsigned long long step, bool at_end) const;
  /// @param share of the run that is done
  /// @param stage what a process is doing
  void report(const Clock &clock, std::uint64_t n_particles, double share,
              const std::string &stage);

  double particle_steps() const { return steps_of_particles; }
  double particle_steps_per_second() const
  {
    return loop_seconds > 0. ? steps_of_particles / loop_seconds : 0.;
  }
  double seconds_of_loop() const { return loop_seconds; }
  double seconds_of_run() const { return MPI_Wtime() - start_of_run; }
  /// Share of the particles' steps in which they slept; collective.
  double share_asleep(MPI_Comm comm) const;

  /// Adds the times of all parts to the keys of summary.json; collective.
  /// @return shares of the loop, in words
  std::string add_times(nlohmann::ordered_json &summary, MPI_Comm comm) const;

private:
  Log &log;
  const unsigned long long log_frequency;
  const double start_of_run;
  double start_of_loop = 0., loop_seconds = 0.;
  double steps_of_particles = 0.; ///< of all ranks
  double steps_asleep = 0.;       ///< of this rank's particles
  double share_before = -1.;      ///< of the run that was done before this part, once it is known
  unsigned long long last_reported_step = 0;
  double last_report = 0., reported_steps_of_particles = 0.;
};

} // namespace eunoe

#endif
