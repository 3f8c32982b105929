// Checkpoints of a simulation and the continuation from them.
//
// A checkpoint holds the state between two steps: particles with their contacts and with their
// references, on which the order of all lists depends. So writing one
// changes nothing, and a run that continues goes on with the same bits. Each part of the simulation
// saves and loads what it remembers. With another input a run begins a phase: it takes the
// particles and their contacts over and all else from the input.

#include <eunoe/checkpoint/head_values.h>
#include <eunoe/simulation/simulation.h>

namespace eunoe {

void Simulation::save(CheckpointWriter &writer)
{
  complete_step();
  writer.head["clock"] = clock.save();
  writer.head["insertion"] = inserter.save();
  writer.head["domain"] = domain.save();
  writer.head["solids"] = solids.save();
  if (sleeper.is_enabled())
    writer.head["sleep"] = sleeper.save();
  if (tuner)
    writer.head["skin"] = tuner->save();
  writer.head["most_squeezed"] = guard.most_squeezed();
  system.save(writer);
  if (process)
    process->save(writer);
}

void Simulation::resume()
{
  checkpoints.go_on();
  const Checkpoint &checkpoint = *checkpoints.opened();
  checkpoints.understand([&](const nlohmann::ordered_json &head) {
    const bool is_phase = checkpoints.begins_phase();
    const Clock::End end = [this](const unsigned long long step, const double time) {
      return parameters.control.last_step(step, time);
    };
    if (is_phase)
      clock.begin_phase(head.at("clock"), end);
    else
      clock.load(head.at("clock"), end);
    // Before the particles: it knows where the solids of the process are by now.
    if (process)
      process->resume(*this, checkpoint);
    if (is_phase)
      begin_phase(checkpoint);
    else
      go_on(checkpoint);
    if (checkpoints.is_own())
      outputs.load(head.at("outputs"));
  });
  move_solids();
  get_log().line("Continuing from " + checkpoint.path + ": step " + std::to_string(clock.step()) +
                 ", t = " + format(clock.time()) + " s, " + std::to_string(system.n_global()) +
                 " particles");
  checkpoints.close();
  if (checkpoints.begins_phase() && inserter.waits_for_ever())
    get_log().warning(
        "Nothing is inserted in this phase, although not all particles have come: with "
        "'insertion frequency = 0' they come at the first step of a run only. Give a "
        "frequency.");
  if (checkpoints.is_own())
    return;
  if (outputs.want_solid_loads(clock.step()))
    system.add_solid_loads(solids.list(), clock.time(), solids.new_loads());
  outputs.begin(clock, *this);
}

/// Continues as if the run had not stopped.
void Simulation::go_on(const Checkpoint &checkpoint)
{
  const nlohmann::ordered_json &head = checkpoint.head;
  balancer.load(head.at("balancing"));
  domain.load(head.at("domain"));
  solids.load(head.at("solids"));
  guard.set_most_squeezed(count_in(head.at("most_squeezed")));
  if (sleeper.is_enabled())
    sleeper.load(head.at("sleep"), solids.list().size());
  // The lists are made with the skin of the last search.
  if (tuner) {
    tuner->load(head.at("skin"));
    use_skin();
  }
  system.load(checkpoint, solids.list(), parameters.load_balancing, sleeper.get(), false, true);
}

/// Whether particles have passed an outlet of a mesh that moves depends on where it was at the last
/// search.
void Simulation::place_domain_of(const Checkpoint &checkpoint)
{
  domain.load(checkpoint.head.at("domain"));
  domain.move_to(checkpoints.time());
}

/// Refuses a phase whose particles do not fit into it, before anything is written.
void Simulation::check_guests()
{
  checkpoints.understand([this](const nlohmann::ordered_json &) {
    const Checkpoint &checkpoint = *checkpoints.opened();
    place_domain_of(checkpoint);
    system.check_guests(checkpoint, solids.list());
  });
}

/// Takes the particles and what their contacts remember, and goes on with what the input says now:
/// with other walls, solids, laws, loads, steps.
void Simulation::begin_phase(const Checkpoint &checkpoint)
{
  place_domain_of(checkpoint);
  move_solids();
  for (const auto &[name, way] : solids.jumps(checkpoint.head.at("solids")))
    if (way > criterion.allowed_displacement())
      get_log().warning(
          "'" + name + "' stands up to " + format(way) +
          " m from where it stood, as motions count from t = 0 and not from the "
          "beginning of a phase. Give it a motion that has brought it there by then.");
  // A process has the outlets that it had, and measures what goes through them.
  const bool keeps_ledger = process != nullptr;
  for (const std::string &loss : system.load(checkpoint, solids.list(), parameters.load_balancing,
                                             sleeper.get(), true, keeps_ledger))
    get_log().line(loss);
  note_search();
  if (sleeper.is_enabled())
    update_sleep(true, false);
  constexpr ParticleId all = 0;
  system.start_forces_on_new(all, solids.list(), clock.time());
}

void Simulation::dump(const std::string &path)
{
  CheckpointWriter writer(communicator());
  save(writer);
  writer.write(path);
}

void Simulation::checkpoint_if_due()
{
  if (checkpoints.is_due(clock.step()))
    write_checkpoint();
}

void Simulation::write_checkpoint()
{
  const Timers::Scope scope(progress.timers, Section::output);
  CheckpointWriter writer(communicator());
  save(writer);
  // Not in a dump, as these depend on the distribution of the work or on the files written.
  writer.head["balancing"] = balancer.save();
  writer.head["input"] = parameters.as_input_file();
  writer.head["outputs"] = outputs.save();
  checkpoints.write(writer, clock.step(), get_log());
}

} // namespace eunoe
