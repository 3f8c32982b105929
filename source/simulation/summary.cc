// What a run says of itself at its end: summary.json and the last lines of the log.

#include <eunoe/core/version.h>
#include <eunoe/simulation/simulation.h>

#include <nlohmann/json.hpp>

#include <array>
#include <map>

namespace eunoe {

namespace {

using Json = nlohmann::ordered_json;

void add(Json &summary, const std::string &name, const Tally &tally)
{
  summary[name + "_particles"] = tally.number;
  summary[name + "_mass"] = tally.mass.value();
}

/// Where particles came from and went, and whether their masses add up to nothing; collective.
void add_balance(Json &summary, const ParticleSystem &system, const Domain &domain)
{
  MPI_Comm comm = domain.communicator();
  const Ledger &ledger = system.get_ledger();
  const Tally inserted = ledger.inserted.global(comm), taken = ledger.taken_out.global(comm),
              lost = ledger.lost.global(comm);
  add(summary, "inserted", inserted);
  add(summary, "taken_out", taken);
  add(summary, "lost", lost);
  ExactSum balance = inserted.mass;
  balance -= lost.mass;
  balance -= taken.mass;
  std::map<unsigned int, Tally> through_boundary;
  for (std::size_t o = 0; o < ledger.through_outlet.size(); ++o)
    through_boundary[domain.outlets()[o].boundary_id] += ledger.through_outlet[o];
  std::uint64_t left = 0;
  for (const auto &[id, tally] : through_boundary) {
    const Tally out = tally.global(comm);
    add(summary, "outlet_" + std::to_string(id), out);
    balance -= out.mass;
    left += out.number;
  }
  Tally inside;
  for (std::size_t k = 0; k < system.particles.n_owned; ++k)
    inside.count(system.particles.mass(k));
  inside = inside.global(comm);
  summary["outlet_particles"] = left;
  summary["inside_mass"] = inside.mass.value();
  balance -= inside.mass;
  summary["mass_balance_error"] = balance.value();
}

void add_energies(Json &summary, const ParticleArrays &p, MPI_Comm comm)
{
  ExactSum kinetic, rotational;
  for (std::size_t k = 0; k < p.n_owned; ++k) {
    kinetic += 0.5 * p.mass(k) * norm_square(p.velocity[k].vec());
    rotational += 0.5 * p.moment_of_inertia(k) * norm_square(p.spin[k].vec());
  }
  kinetic.reduce(comm);
  rotational.reduce(comm);
  summary["kinetic_energy"] = kinetic.value();
  summary["rotational_energy"] = rotational.value();
}

} // namespace

void Simulation::write_summary()
{
  MPI_Comm comm = communicator();
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  Json summary;
  summary["version"] = version();
  summary["git_revision"] = git_revision();
  summary["deal_ii_version"] = deal_ii_version();
  summary["particles"] = system.n_global();
  summary["steps"] = clock.step();
  summary["first_step"] = clock.first_step();
  summary["ranks"] = n_ranks;
  std::array<std::uint64_t, 2> ghosts = {system.particles.n_ghosts, system.n_paired_ghosts()};
  MPI_Allreduce(MPI_IN_PLACE, ghosts.data(), 2, MPI_UINT64_T, MPI_SUM, comm);
  summary["ghosts"] = ghosts[0];
  summary["ghosts_in_pairs"] = ghosts[1];
  summary["mesh_cells"] = system.get_store().n_cells();
  summary["time_step"] = clock.time_step();
  summary["simulated_time"] = clock.time();
  summary["particle_steps"] = progress.particle_steps();
  summary["particle_steps_per_second"] = progress.particle_steps_per_second();
  summary["loop_seconds"] = progress.seconds_of_loop();
  summary["wall_seconds"] = progress.seconds_of_run();
  summary["share_asleep"] = progress.share_asleep(comm);
  summary["contact_searches"] = system.n_searches();
  summary["searches_in_place"] = system.n_searches_in_place();
  summary["neighborhood_threshold"] = system.neighborhood_threshold();
  summary["threshold_changes"] = tuner ? tuner->n_changes() : 0ULL;
  summary["load_balances"] = system.n_balances();
  summary["most_squeezed_particles"] = guard.most_squeezed();
  add_balance(summary, system, domain);
  add_energies(summary, system.particles, comm);
  if (process)
    process->add_to_summary(summary);
  const std::string shares = progress.add_times(summary, comm);
  outputs.folder.write("summary.json", summary.dump(2) + "\n");
  get_log().line("Finished " + format_count(static_cast<double>(clock.step()), "step", "steps") +
                 " in " + format_duration(progress.seconds_of_loop()) + ": " +
                 format(progress.particle_steps_per_second() * 1e-6) +
                 " million particle-steps/s. Share of time: " + shares);
  if (guard.most_squeezed() > 0)
    get_log().warning(
        "up to " + format_count(static_cast<double>(guard.most_squeezed()), "overlap", "overlaps") +
        " at a time exceeded the 'largest overlap', where no contact law holds.");
  get_log().line("Results are in " + outputs.folder.path);
}

} // namespace eunoe
