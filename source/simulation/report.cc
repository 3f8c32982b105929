// What a run says of itself: the overview at its start, its progress, and summary.json.

#include <eunoe/core/version.h>
#include <eunoe/simulation/simulation.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

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

void Simulation::print_overview()
{
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  log.line("Eunoe " + std::string(version()) + " on " + format_count(n_ranks, "rank", "ranks"));
  output.write("used.prm", parameters.as_input_file());
}

void Simulation::report_progress(const bool at_end)
{
  const ControlParameters &control = parameters.control;
  const double now = MPI_Wtime();
  // On a terminal by the clock, asked for rarely; elsewhere by the step.
  const bool due = at_end || (control.log_frequency > 0 && step % control.log_frequency == 0) ||
                   (log.is_terminal() && step % 256 == 0 && now - last_report > 0.5);
  if (!due || (at_end && last_reported_step == step))
    return;
  last_reported_step = step;
  Log::Progress progress;
  progress.step = step;
  progress.time = present_time;
  progress.particles = n_particles;
  progress.share = static_cast<double>(step) / static_cast<double>(control.n_steps());
  if (const Process *const process = parameters.process()) {
    progress.share = at_end ? 1. : process->progress(*this);
    progress.stage = process->stage();
  }
  if (share_before < 0.)
    share_before = first_step > 0 ? progress.share : 0.;
  progress.share_before = share_before;
  progress.elapsed = now - start_of_run;
  progress.speed = (particle_steps - reported_particle_steps) /
                   std::max(1e-9, now - (last_report > 0. ? last_report : start_of_run)) * 1e-6;
  last_report = now;
  reported_particle_steps = particle_steps;
  log.progress(progress);
}

void Simulation::write_summary()
{
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  nlohmann::ordered_json summary;
  summary["version"] = version();
  summary["git_revision"] = git_revision();
  summary["deal_ii_version"] = deal_ii_version();
  summary["particles"] = n_particles;
  summary["steps"] = step;
  summary["first_step"] = first_step;
  summary["ranks"] = n_ranks;
  std::array<std::uint64_t, 2> ghosts = {system.particles.n_ghosts, system.n_paired_ghosts()};
  MPI_Allreduce(MPI_IN_PLACE, ghosts.data(), 2, MPI_UINT64_T, MPI_SUM, comm);
  summary["ghosts"] = ghosts[0];
  summary["ghosts_in_pairs"] = ghosts[1];
  summary["time_step"] = parameters.control.time_step;
  summary["simulated_time"] = present_time;
  summary["particle_steps"] = particle_steps;
  summary["particle_steps_per_second"] = loop_seconds > 0. ? particle_steps / loop_seconds : 0.;
  summary["loop_seconds"] = loop_seconds;
  summary["wall_seconds"] = MPI_Wtime() - start_of_run;
  double slept = sleeping_steps;
  MPI_Allreduce(MPI_IN_PLACE, &slept, 1, MPI_DOUBLE, MPI_SUM, comm);
  summary["share_asleep"] = particle_steps > 0. ? slept / particle_steps : 0.;
  summary["contact_searches"] = system.n_searches();
  summary["load_balances"] = system.n_balances();

  const Tally inserted = ledger.inserted.global(comm), taken = ledger.taken_out.global(comm);
  summary["inserted_particles"] = inserted.number;
  summary["inserted_mass"] = inserted.mass.value();
  summary["taken_out_particles"] = taken.number;
  summary["taken_out_mass"] = taken.mass.value();
  const Tally lost = ledger.lost.global(comm);
  summary["lost_particles"] = lost.number;
  summary["lost_mass"] = lost.mass.value();
  ExactSum balance = inserted.mass;
  balance -= lost.mass;
  balance -= taken.mass;
  std::uint64_t left = 0;
  std::map<unsigned int, Tally> through_boundary;
  for (std::size_t o = 0; o < ledger.through_outlet.size(); ++o)
    through_boundary[domain.outlets()[o].boundary_id] += ledger.through_outlet[o];
  for (const auto &[id, tally] : through_boundary) {
    const Tally out = tally.global(comm);
    const std::string name = "outlet_" + std::to_string(id);
    summary[name + "_particles"] = out.number;
    summary[name + "_mass"] = out.mass.value();
    balance -= out.mass;
    left += out.number;
  }
  Tally inside;
  ExactSum kinetic, rotational;
  const ParticleArrays &p = system.particles;
  for (std::size_t k = 0; k < p.n_owned; ++k) {
    inside.count(p.mass(k));
    kinetic += 0.5 * p.mass(k) * norm_square(p.velocity[k].vec());
    rotational += 0.5 * p.moment_of_inertia(k) * norm_square(p.spin[k].vec());
  }
  inside = inside.global(comm);
  kinetic.reduce(comm);
  rotational.reduce(comm);
  summary["outlet_particles"] = left;
  summary["inside_mass"] = inside.mass.value();
  balance -= inside.mass;
  summary["mass_balance_error"] = balance.value();
  summary["kinetic_energy"] = kinetic.value();
  summary["rotational_energy"] = rotational.value();

  if (const Process *const process = parameters.process())
    process->add_to_summary(summary);

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
  output.write("summary.json", summary.dump(2) + "\n");
  log.line("Finished " + format_count(static_cast<double>(step), "step", "steps") + " in " +
           format_duration(loop_seconds) + ": " +
           format(loop_seconds > 0. ? particle_steps / loop_seconds * 1e-6 : 0.) +
           " million particle-steps/s. Share of time: " + shares);
  log.line("Results are in " + parameters.control.output_path);
}

} // namespace eunoe
