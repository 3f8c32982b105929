#include <eunoe/core/files.h>
#include <eunoe/core/stop_request.h>
#include <eunoe/simulation/simulation.h>

#include "announcements.h"
#include "judgements.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe {

namespace {

/// Prepares the parameters that a process decides, before anything is built from them.
Parameters &prepare(Parameters &parameters)
{
  if (Process *const process = parameters.process())
    process->prepare(parameters);
  return parameters;
}

/// Extra doubles of the particles: the process's, then those that tell who sleeps.
std::vector<ParticleField> make_fields(const Parameters &parameters)
{
  std::vector<ParticleField> fields;
  if (const Process *const process = parameters.process())
    fields = process->fields();
  if (parameters.sparse_contacts.enabled)
    for (const ParticleField &field : SparseContacts::fields())
      fields.push_back(field);
  return fields;
}

/// Null for a process, which makes its own.
std::unique_ptr<Insertion> make_insertion(const Parameters &parameters, MPI_Comm comm, Log &log)
{
  if (parameters.process_name != "none")
    return nullptr;
  announce_insertion(parameters, log);
  return insertion_methods().make(parameters.insertion.method, parameters.insertion,
                                  parameters.physics, comm);
}

/// The mesh, with a word before it if its making takes long.
/// @param is_check whether nothing will run in it
Background background_of(const Parameters &parameters, const bool is_check, Log &log)
{
  Background background = {parameters.mesh, parameters.refinement, parameters.grid_motion.make()};
  // Insertion by a plane counts the cells.
  background.is_only_looked_at =
      is_check && (parameters.process_name != "none" || parameters.insertion.method != "plane");
  announce_mesh(background, log);
  return background;
}

} // namespace

Simulation::Simulation(Parameters &parameters_, MPI_Comm comm, Log &log, const Purpose purpose)
    : parameters(prepare(parameters_)), comm(comm), log(log), start_of_run(MPI_Wtime()),
      insertion(make_insertion(parameters, comm, log)),
      largest_diameter(insertion ? insertion->largest_diameter()
                                 : parameters.physics.largest_diameter()),
      skin(parameters.model.skin(largest_diameter)),
      domain(background_of(parameters, purpose == Purpose::check, log), parameters.boundaries,
             parameters.physics.wall_material(), comm),
      model(parameters.contact_model(largest_diameter)),
      guard(domain, model.get_materials(), parameters.model.largest_overlap),
      fields(make_fields(parameters)),
      sparse(parameters.sparse_contacts, fields, parameters.control.time_step),
      ledger(domain.outlets()), system(domain, model, n_components(fields), sparse.flag(), skin,
                                       largest_diameter, ledger, timers),
      integrator(integrators().make(parameters.model.integration_method)),
      output(parameters.control.output_path, comm),
      checkpoints(parameters.control.output_path, parameters.restart.filename,
                  parameters.restart.keep, comm),
      allowed_displacement(parameters.model.displacement_share * skin)
{
  Problems problems;
  check_domain(domain, parameters, largest_diameter + skin + model.range(), problems);
  if (insertion) {
    check_places(domain, insertion->known_places(), comm, problems);
    insertion->check(domain, problems);
  }
  const int wall = parameters.physics.wall_material();
  solids = domain.walls();
  const auto append = [this](const std::vector<Solid> &more) {
    solids.insert(solids.end(), more.begin(), more.end());
  };
  append(parameters.floating_walls.make(wall));
  append(parameters.solids.make(wall, parameters.control.time_step, comm, problems));
  find_checkpoint(problems);
  if (!problems.empty())
    throw UserError(problems);
  if (Process *const process = parameters.process()) {
    const std::size_t n_given = solids.size();
    append(process->make_solids(parameters));
    check_crossings(solids, n_given, problems);
  }
  give_materials(solids, parameters.physics, problems);
  std::vector<double> defaults;
  for (const ParticleField &field : fields)
    defaults.insert(defaults.end(), field.n_components, field.initial);
  system.set_extra_defaults(defaults);
  if (!problems.empty())
    throw UserError(problems);
  solid_loads.resize(solids.size());
  for (const auto &[name, section] : parameters.loads)
    if (auto load = section->make(parameters.physics))
      loads.push_back(std::move(load));
  // A trial without a folder finds what is wrong with them before anything is written.
  for (const auto &[name, section] : parameters.observables)
    section->make(*this);
}

RunEstimate Simulation::estimate() const
{
  if (!insertion)
    return parameters.process()->estimate(parameters);
  RunEstimate estimate;
  estimate.steps = static_cast<double>(parameters.control.n_steps());
  estimate.most_particles = static_cast<double>(insertion->supply(number_of_events(parameters)));
  estimate.particles = estimate.most_particles;
  return estimate;
}

void Simulation::open_output()
{
  output.open();
  int rank;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0)
    // One of an earlier run would make this one look finished.
    remove_file(output.file("summary.json"));
  if (checkpoint)
    resume_output();
  particle_pictures = output.pictures(parameters.control.output_name);
  solid_pictures = output.pictures(parameters.control.output_name + "_solids");
  make_observables();
}

void Simulation::make_observables()
{
  for (const auto &[name, section] : parameters.observables)
    if (auto observable = section->make(*this))
      observable_list[name] = std::move(observable);
}

Simulation::~Simulation() = default;

int Simulation::find_solid(const std::string &name) const
{
  const auto it =
      std::find_if(solids.begin(), solids.end(), [&](const Solid &s) { return s.name == name; });
  return it == solids.end() ? -1 : static_cast<int>(it - solids.begin());
}

bool Simulation::run(const std::function<void(Simulation &)> &look)
{
  if (!output.is_open() && observable_list.empty())
    make_observables();
  print_overview();
  if (parameters.restart.checkpoint)
    stop_request::listen();
  if (checkpoint)
    resume();
  else
    start();
  last_checkpoint = MPI_Wtime();
  if (look)
    look(*this);
  timers = Timers();
  const double start_of_loop = MPI_Wtime();
  while (!finished() && !stopped) {
    advance();
    do_what_is_due();
    if (look)
      look(*this);
    checkpoint_if_due();
  }
  loop_seconds = MPI_Wtime() - start_of_loop;
  complete_step();
  if (stopped)
    return false;
  for (const auto &[name, observable] : observable_list)
    observable->finish(*this);
  report_progress(true);
  write_measurements();
  write_summary();
  return true;
}

void Simulation::start()
{
  move_solids();
  if (parameters.process() != nullptr)
    parameters.process()->start(*this);
  else
    exchange({}, {});
  do_what_is_due();
}

/// The time step.
void Simulation::advance()
{
  const double dt = parameters.control.time_step;
  ++step;
  present_time = static_cast<double>(step) * dt;
  move_solids();

  double moved2;
  {
    const Timers::Scope scope(timers, Section::integration);
    moved2 = integrator->begin_step(system.particles, dt);
  }
  ask_for_search(moved2);
  const bool look_is_due =
      sparse.is_enabled() && (step % sparse.frequency() == 0 || solid_starts());
  if (!look_is_due) {
    // While the answers of all ranks come; in vain if they want a search.
    const Timers::Scope scope(timers, Section::ghosts);
    system.update_ghosts();
  }
  const bool searches = search_is_due();
  const bool looks = look_is_due || (sparse.is_enabled() && searches);
  if (searches) {
    const Timers::Scope scope(timers, Section::search);
    const std::vector<std::size_t> lost = inspect();
    if (sparse.is_enabled())
      system.stir_around_leaving(sparse, lost, step);
    system.search(solids, balance_if_due(), lost);
    for (std::size_t s = 0; s < solids.size(); ++s)
      solids_at_search[s] = solids[s].state;
    domain.keep_pose();
    n_particles = system.n_global();
  }
  if (looks)
    update_sleep(false);

  if (parameters.model.forgets_at(step))
    system.forget_contacts();
  compute_forces(dt);
  integrator->end_step();
  particle_steps += static_cast<double>(n_particles);
  sleeping_steps += static_cast<double>(system.particles.n_owned - system.particles.n_awake());
}

void Simulation::move_solids()
{
  domain.move_to(present_time);
  for (Solid &solid : solids)
    solid.state = solid.motion->at(present_time);
}

void Simulation::compute_forces(const double dt)
{
  {
    const Timers::Scope scope(timers, Section::loads);
    for (const auto &load : loads)
      load->add(system.particles, present_time);
  }
  const Process *const process = parameters.process();
  const bool wanted =
      (process != nullptr && process->wants_solid_loads(step)) ||
      std::any_of(observable_list.begin(), observable_list.end(),
                  [this](const auto &entry) { return entry.second->wants_solid_loads(step); });
  if (wanted)
    solid_loads.assign(solids.size(), SolidLoad());
  system.add_contact_forces(solids, present_time, dt, wanted ? &solid_loads : nullptr);
}

/// Asks how far particles have moved on any rank since the last search.
/// @param moved2 square of the largest displacement of those who are awake on this one (m2)
void Simulation::ask_for_search(double moved2)
{
  // Sleepers stay where they have drifted to. Where it is no number, it stays none.
  if (moved2 < system.particles.sleepers_moved2)
    moved2 = system.particles.sleepers_moved2;
  const ModelParameters &p = parameters.model;
  largest_displacement = 0.;
  if (step % p.detection_frequency != 0)
    return;
  // How the largest over ranks treats what is no number depends on the MPI.
  if (p.detection_method == "constant" || std::isnan(moved2))
    largest_displacement = std::numeric_limits<double>::infinity();
  else
    largest_displacement = std::sqrt(moved2);
  MPI_Iallreduce(MPI_IN_PLACE, &largest_displacement, 1, MPI_DOUBLE, MPI_MAX, comm, &answer);
}

bool Simulation::search_is_due()
{
  if (answer == MPI_REQUEST_NULL)
    return false;
  MPI_Wait(&answer, MPI_STATUS_IGNORE);
  double solid_moved = 0.;
  for (std::size_t s = 0; s < solids.size(); ++s)
    solid_moved =
        std::max(solid_moved, displacement(solids[s], solids_at_search[s], solids[s].state));
  const double moved = largest_displacement;
  return !(moved + std::max(moved, solid_moved) <= allowed_displacement);
}

const LoadBalancingParameters *Simulation::balance_if_due()
{
  const LoadBalancingParameters &p = parameters.load_balancing;
  bool due = false;
  if (p.method == "once")
    due = !balanced_once && step >= p.step;
  else if (p.method == "frequent")
    due = step >= last_balance + p.frequency;
  else if (p.method == "dynamic" && step >= last_balance + p.check_frequency) {
    last_balance = step;
    due = system.imbalance(p) > p.threshold;
  }
  if (!due)
    return nullptr;
  balanced_once = true;
  last_balance = step;
  return &p;
}

const ParticleArrays &Simulation::complete_step()
{
  integrator->complete(system.particles, parameters.control.time_step);
  return system.particles;
}

ParticleArrays &Simulation::changeable_particles()
{
  complete_step();
  return system.particles;
}

void Simulation::write_pictures(PictureSeries &series)
{
  complete_step();
  const Timers::Scope scope(timers, Section::output);
  std::vector<PictureField> more;
  for (const auto &[name, observable] : observable_list)
    for (PictureField &field : observable->fields(*this))
      more.push_back(std::move(field));
  series.write(present_time, system.particles, fields, more);
}

/// What happens between two steps, at the present time.
void Simulation::do_what_is_due()
{
  insert_if_due();
  if (parameters.process() != nullptr) {
    const Timers::Scope scope(timers, Section::process);
    parameters.process()->step(*this);
  }
  for (const auto &[name, observable] : observable_list)
    observable->step(*this);

  const ControlParameters &control = parameters.control;
  const double half_step = 0.5 * control.time_step;
  const bool output_due =
      control.output_control == "time"
          ? present_time >= next_output - half_step
          : control.output_frequency > 0 && step % control.output_frequency == 0;
  const bool in_window = present_time >= control.output_window[0] - half_step &&
                         present_time <= control.output_window[1] + half_step;
  if (output_due)
    next_output += control.output_time;
  if (output_due && in_window && output.is_open()) {
    write_pictures(*particle_pictures);
    const Timers::Scope scope(timers, Section::output);
    solid_pictures->write(present_time, solids);
    for (const auto &[name, observable] : observable_list)
      observable->draw(*this);
  }
  report_progress(false);
}

bool Simulation::finished() const
{
  return step >= parameters.control.n_steps() ||
         (parameters.process() != nullptr && parameters.process()->finished());
}

} // namespace eunoe
