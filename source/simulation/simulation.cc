// What a simulation is made of, and how it goes through time.

#include <eunoe/core/first_rank.h>
#include <eunoe/core/version.h>
#include <eunoe/simulation/simulation.h>

#include "announcements.h"
#include "judgements.h"
#include "parts.h"
#include <nlohmann/json.hpp>

#include <limits>

namespace eunoe {

Simulation::Simulation(const Parameters &input, MPI_Comm comm, Log &log)
    : parameters(input.of_run()), process(make_process(parameters)),
      progress(log, parameters.control.log_frequency),
      inserter(parameters.insertion, make_insertion(parameters, comm, log)),
      domain(background_of(parameters, log), parameters.boundaries,
             parameters.physics.wall_material(), comm),
      clock(parameters.control.time_step, parameters.control.n_steps()),
      sleeper(parameters.sparse_contacts, norm(parameters.physics.gravity), clock.time_step()),
      system(domain, physics_of(parameters, inserter, process.get(), sleeper),
             skin_of(parameters, inserter, domain), largest_diameter(parameters, inserter),
             progress.timers),
      integrator(parameters.integration.make()),
      criterion(parameters.detection, skin_of(parameters, inserter, domain), comm),
      tuner(skin_tuner_of(parameters, inserter, domain)), balancer(parameters.load_balancing),
      guard(parameters.faults, domain, system.contact_model().get_materials(),
            parameters.contacts.normal_laws(), criterion.longest_way(), clock.time_step()),
      checkpoints(parameters.restart, parameters.control.output_path, comm),
      outputs(parameters.control, progress.timers, comm)
{
  Problems problems;
  const Skins skins(parameters, inserter);
  check_domain(domain, parameters, skins.contact + skins.least, problems);
  if (skins.in(domain.periods()) < skins.wanted)
    log.line("A period of the domain is short: the skin is " + format(skins.in(domain.periods())) +
             " m instead of " + format(skins.wanted) + " m, so contacts are searched more often.");
  std::vector<Solid> all = given_solids(problems);
  checkpoints.find(
      parameters.entries(), parameters.changed_entries(), parameters.file_entries(),
      parameters.control,
      [this](const Problems &differences, const nlohmann::ordered_json &head, Problems &found) {
        check_phase(parameters, differences, head, found);
      },
      log, problems);
  if (checkpoints.opened() != nullptr)
    checkpoints.understand(
        [this](const nlohmann::ordered_json &head) { inserter.load(head.at("insertion")); });
  // A run that goes on with the same input has passed these when it began.
  if (const Insertion *const method = inserter.get_method();
      method != nullptr &&
      (checkpoints.opened() == nullptr || (checkpoints.begins_phase() && inserter.brings_more())))
  {
    check_places(domain, method->known_places(), comm, problems);
    method->check(domain, problems);
  }
  if (!problems.empty())
    throw UserError(problems);
  const std::size_t n_given = all.size();
  if (process) {
    process->add_solids(all);
    check_crossings(all, n_given, problems);
  }
  give_materials(all, parameters.physics, problems);
  if (!problems.empty())
    throw UserError(problems);
  solids.take(std::move(all), n_given);
  if (checkpoints.begins_phase())
    check_guests();
  // A trial without a folder finds what is wrong with them before anything is written.
  for (const auto &[name, section] : parameters.observables)
    section->make(*this);
}

Simulation::~Simulation() = default;

/// Walls of the domain and solids of the input.
std::vector<Solid> Simulation::given_solids(Problems &problems) const
{
  const int wall = parameters.physics.wall_material();
  std::vector<Solid> all = domain.walls();
  for (const std::vector<Solid> &more :
       {parameters.floating_walls.make(wall),
        parameters.solids.make(wall, clock.time_step(), communicator(), problems)})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

RunEstimate Simulation::estimate() const
{
  const Insertion *const method = inserter.get_method();
  if (method == nullptr)
    return parameters.process()->estimate(parameters);
  RunEstimate estimate;
  estimate.steps = static_cast<double>(parameters.control.n_steps());
  estimate.most_particles = static_cast<double>(method->supply(number_of_events(parameters)));
  estimate.particles = estimate.most_particles;
  return estimate;
}

void Simulation::open_output()
{
  for (const std::string &weakness : {outputs.folder.open(), checkpoints.occupy()})
    if (!weakness.empty())
      get_log().warning("The file system cannot lock a file: " + weakness +
                        ". So a second run into the same folder would not be refused.");
  checkpoints.check_newest();
  if (checkpoints.opened() == nullptr || !checkpoints.is_own())
    outputs.begin_series(nullptr);
  else
    checkpoints.understand(
        [this](const nlohmann::ordered_json &head) { outputs.begin_series(&head.at("outputs")); });
  make_observables(); // may refuse to go on in a table that was changed
}

/// Replaces the files of an earlier run that say what it was and that it is finished, and marks its
/// checkpoints.
void Simulation::begin_results(const bool goes_on)
{
  if (!outputs.folder.is_open())
    return;
  checkpoints.begin_results();
  std::vector<std::string> old = {"summary.json", "measurements.csv"};
  if (!goes_on)
    for (const auto &[name, section] : parameters.processes)
      for (const std::string &file : section->results())
        old.push_back(file);
  outputs.folder.remove_old(old);
  outputs.folder.write("used.prm", parameters.as_input_file());
}

void Simulation::make_observables()
{
  outputs.make_observables(parameters.observables, *this);
}

bool Simulation::run(const std::function<void(Simulation &)> &look)
{
  if (!outputs.folder.is_open() && !outputs.has_observables())
    make_observables();
  int n_ranks;
  MPI_Comm_size(communicator(), &n_ranks);
  get_log().line("Eunoe " + std::string(version()) + " on " +
                 format_count(n_ranks, "rank", "ranks"));
  checkpoints.begin();
  if (checkpoints.opened() != nullptr) {
    const bool is_own = checkpoints.is_own();
    resume(); // may refuse, and the results of the run before it must be there still
    begin_results(is_own);
  } else {
    begin_results(false);
    start();
  }
  if (look)
    look(*this);
  progress.begin_loop();
  while (!finished() && !checkpoints.is_stopped()) {
    advance();
    do_what_is_due();
    if (look)
      look(*this);
    checkpoint_if_due();
  }
  progress.end_loop();
  complete_step();
  if (checkpoints.is_stopped())
    return false;
  if (process && !process->finished())
    throw UserError("The run has come to its bound of " + format(time()) +
                    " s before all that its process does.");
  // So that another phase can begin where this one ends.
  if (checkpoints.is_due_at_end(clock.step()))
    write_checkpoint();
  outputs.finish(*this);
  report_progress(true);
  write_measurements();
  write_summary();
  return true;
}

void Simulation::start()
{
  move_solids();
  if (process)
    process->start(*this);
  else
    insert_and_remove({}, {});
  do_what_is_due();
}

void Simulation::advance()
{
  clock.advance();
  move_solids();

  Travel travel;
  {
    const Timers::Scope scope(progress.timers, Section::integration);
    travel = integrator->begin_step(system.particles, clock.time_step());
  }
  if (!is_integrator_checked)
    check_integrator();
  // Sleepers keep the displacement from before their sleep.
  travel.include(system.particles.sleepers_moved2);
  criterion.ask(clock.step(), travel, system.near_share());
  const bool look_is_due = sleeper.is_look_due(clock, solids.list());
  if (!look_is_due) {
    // Done while the answers of all ranks arrive; wasted if these demand a search.
    const Timers::Scope scope(progress.timers, Section::ghosts);
    system.update_ghosts();
  }
  const bool searches = criterion.is_due(solids) || (tuner && tuner->is_look_due(clock.step()));
  system.note_step(criterion.largest_paces(), criterion.typical_step(),
                   criterion.largest_near_share());
  if (searches) {
    if (look_is_due)
      system.update_ghosts(); // for the inspection
    search();
  }
  if (look_is_due || (sleeper.is_enabled() && searches))
    update_sleep(false, true);

  if (const ContactHistoryParameters &history = parameters.contact_history;
      history.forgets_at(clock.step()))
    system.forget_contacts(history.between_particles(), history.with_solids());
  compute_forces();
  integrator->end_step();
  progress.count_step(system.n_global(), system.particles.n_owned - system.particles.n_awake());
}

/// That of a plug-in may have been written for forces that begin at zero, and all would float.
void Simulation::check_integrator()
{
  if (system.n_global() == 0)
    return;
  on_every_rank(communicator(), [this] {
    if (!system.particles.have_their_weights())
      throw UserError("The integration method '" +
                      parameters.entries().at({{"model parameters"}, "integration method"}) +
                      "' leaves particles without their weight. Its begin_step must call "
                      "ParticleArrays::start_forces for each that is awake.");
  });
  is_integrator_checked = true;
}

const ParticleArrays &Simulation::complete_step()
{
  integrator->complete(system.particles, clock.time_step());
  return system.particles;
}

ParticleArrays &Simulation::changeable_particles()
{
  complete_step();
  return system.particles;
}

void Simulation::move_solids()
{
  domain.move_to(clock.time());
  solids.move_to(clock.time());
}

void Simulation::search()
{
  const Timers::Scope scope(progress.timers, Section::search);
  const std::vector<std::size_t> lost = inspect();
  if (sleeper.is_enabled())
    system.stir_around_leaving(sleeper.get(), lost, clock.step());
  const auto imbalance = [this] { return system.imbalance(parameters.load_balancing); };
  const LoadBalancingParameters *const balance = balancer.at_search(clock.step(), imbalance);
  // With another skin the order of particles and the ghosts are others. All particles follow, so
  // that none has used up a part of it.
  const bool is_other_skin = tune_skin();
  const double farthest =
      is_other_skin ? std::numeric_limits<double>::infinity() : criterion.largest_displacement();
  if (is_other_skin || balance != nullptr || !system.search_again(solids.list(), farthest, lost))
    system.search(solids.list(), farthest, balance, lost);
  note_search();
}

bool Simulation::tune_skin()
{
  if (!tuner || !tuner->tune(clock.step(), system.search_load()))
    return false;
  use_skin();
  return true;
}

void Simulation::use_skin()
{
  system.set_skin(tuner->skin());
  criterion.set_skin(tuner->skin());
  guard.set_longest_way(criterion.longest_way());
}

void Simulation::note_search()
{
  solids.note_search();
  domain.note_search();
  if (tuner)
    tuner->note_search(clock.step());
}

void Simulation::update_sleep(const bool wake_all, const bool forces_follow)
{
  const Timers::Scope scope(progress.timers, Section::sleep);
  Stirring stirring = sleeper.look(clock, solids.list(), system.loads(), wake_all);
  stirring.forces_follow = forces_follow;
  system.update_sleep(sleeper.get(), stirring);
}

void Simulation::compute_forces()
{
  const bool wanted = (process && process->wants_solid_loads(clock.step())) ||
                      outputs.want_solid_loads(clock.step());
  system.add_forces(solids.list(), clock.time(), clock.time_step(),
                    wanted ? &solids.new_loads() : nullptr);
}

void Simulation::insert_and_remove(Delivery delivery, const std::vector<std::size_t> &removed)
{
  complete_step();
  const std::vector<std::size_t> lost = inspect();
  if (sleeper.is_enabled() && system.n_global() > 0) {
    // What comes wakes its neighbours, as it has never been at rest.
    std::vector<std::size_t> leaving = removed;
    leaving.insert(leaving.end(), lost.begin(), lost.end());
    system.stir_around_leaving(sleeper.get(), leaving, clock.step());
  }
  ParticleId first_new;
  {
    const Timers::Scope scope(progress.timers, Section::search);
    // The mesh was shared out before there were particles. This changes no result.
    const bool begins = clock.step() == 0 || system.n_global() == 0;
    const unsigned long long shared_before = system.n_balances();
    first_new = system.insert_and_remove(std::move(delivery), removed, lost, solids.list(),
                                         begins ? &parameters.load_balancing : nullptr);
    // By numbers at first; now that lists are there, by work.
    if (system.n_balances() > shared_before)
      system.search(solids.list(), 0., &parameters.load_balancing);
  }
  note_search();
  if (sleeper.is_enabled())
    update_sleep(false, false);
  system.start_forces_on_new(first_new, solids.list(), clock.time());
}

void Simulation::do_what_is_due()
{
  if (inserter.is_due(clock.step())) {
    Inserter::Event event =
        inserter.next_event(domain, system.particles, solids.list(), clock.time());
    if (event.n_outside > 0)
      get_log().line("At t = " + format(time()) + " s, " +
                     format_count(static_cast<double>(event.n_outside), "particle", "particles") +
                     " outside the mesh left out of the insertion");
    insert_and_remove(std::move(event.delivery), event.removed);
  }
  if (process) {
    const Timers::Scope scope(progress.timers, Section::process);
    process->step(*this);
  }
  // Before the first step nothing has computed what solids bear.
  if (clock.step() == 0 && outputs.want_solid_loads(0))
    system.add_solid_loads(solids.list(), clock.time(), solids.new_loads());
  outputs.step(*this);
  if (outputs.are_pictures_due(clock))
    outputs.draw(*this);
  report_progress(false);
}

bool Simulation::finished() const
{
  return clock.is_at_end() || (process && process->finished());
}

void Simulation::report_progress(const bool at_end)
{
  if (!progress.is_report_due(clock.step(), at_end))
    return;
  const double share = !process ? clock.share() : at_end ? 1. : process->progress(*this);
  progress.report(clock, system.n_global(), share, process ? process->stage() : "");
}

} // namespace eunoe
