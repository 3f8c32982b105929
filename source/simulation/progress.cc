#include <eunoe/simulation/progress.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace eunoe {

namespace {

/// Mean and largest value over ranks.
std::pair<double, double> mean_and_max(const double value, MPI_Comm comm)
{
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  double sum = value, largest = value;
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, comm);
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, comm);
  return {sum / n_ranks, largest};
}

std::string percent(double share)
{
  char text[16];
  std::snprintf(text, sizeof text, "%.1f %%", 100. * share);
  return text;
}

} // namespace

void Progress::begin_loop()
{
  timers = Timers();
  start_of_loop = MPI_Wtime();
}

void Progress::count_step(const std::uint64_t n_particles, const std::size_t n_asleep)
{
  steps_of_particles += static_cast<double>(n_particles);
  steps_asleep += static_cast<double>(n_asleep);
}

bool Progress::is_report_due(const unsigned long long step, const bool at_end) const
{
  if (at_end)
    return last_reported_step != step;
  // On a terminal by the clock, asked for rarely; elsewhere by the step.
  return (log_frequency > 0 && step % log_frequency == 0) ||
         (log.is_terminal() && step % 256 == 0 && MPI_Wtime() - last_report > 0.5);
}

void Progress::report(const Clock &clock, const std::uint64_t n_particles, const double share,
                      const std::string &stage)
{
  const double now = MPI_Wtime();
  last_reported_step = clock.step();
  if (share_before < 0.)
    share_before = clock.first_step() > 0 ? share : 0.;
  Log::Progress progress;
  progress.step = clock.step();
  progress.time = clock.time();
  progress.particles = n_particles;
  progress.share = share;
  progress.share_before = share_before;
  progress.stage = stage;
  progress.elapsed = now - start_of_run;
  progress.speed = (steps_of_particles - reported_steps_of_particles) /
                   std::max(1e-9, now - (last_report > 0. ? last_report : start_of_run)) * 1e-6;
  last_report = now;
  reported_steps_of_particles = steps_of_particles;
  log.progress(progress);
}

double Progress::share_asleep(MPI_Comm comm) const
{
  double slept = steps_asleep;
  MPI_Allreduce(MPI_IN_PLACE, &slept, 1, MPI_DOUBLE, MPI_SUM, comm);
  return steps_of_particles > 0. ? slept / steps_of_particles : 0.;
}

std::string Progress::add_times(nlohmann::ordered_json &summary, MPI_Comm comm) const
{
  std::string shares;
  double known = 0.;
  for (unsigned int s = 0; s < Timers::n; ++s) {
    const auto [mean, largest] = mean_and_max(timers[s], comm);
    std::string key = "seconds_" + Timers::name(s);
    std::replace(key.begin(), key.end(), ' ', '_');
    summary[key] = mean;
    summary[key + "_slowest_rank"] = largest;
    known += mean;
    if (loop_seconds > 0.)
      shares += (shares.empty() ? "" : ", ") + Timers::name(s) + " " +
                percent(mean / std::max(known, loop_seconds));
  }
  return shares;
}

} // namespace eunoe
