// Checkpoints of a simulation and the continuation from them.
//
// A checkpoint holds the state between two steps: particles with their contacts and with the places
// where they were at the last search, on which the order of all lists depends. So writing one
// changes nothing, and a run that continues goes on with the same bits.

#include <eunoe/checkpoint/head_values.h>
#include <eunoe/checkpoint/input_differences.h>
#include <eunoe/core/stop_request.h>
#include <eunoe/simulation/simulation.h>

namespace eunoe {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Tally &tally)
{
  return {{"number", tally.number}, {"mass", tally.mass.words()}};
}

/// The tally of all ranks on the first one, nothing on the others.
Tally to_tally(const Json &json, MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  // All ranks read it, so that all find what is wrong with it.
  Tally tally;
  tally.number = count_in(json.at("number"));
  tally.mass = exact_sum_in(json.at("mass"));
  return rank == 0 ? tally : Tally();
}

Json to_json(const RigidState &s)
{
  Json numbers;
  for (const Vec3 &v :
       {s.centre, s.rotation.x, s.rotation.y, s.rotation.z, s.velocity, s.angular_velocity})
    for (unsigned int d = 0; d < 3; ++d)
      numbers.push_back(v[d]);
  return numbers;
}

RigidState to_state(const Json &json)
{
  RigidState s;
  unsigned int k = 0;
  for (Vec3 *const v :
       {&s.centre, &s.rotation.x, &s.rotation.y, &s.rotation.z, &s.velocity, &s.angular_velocity})
    for (unsigned int d = 0; d < 3; ++d)
      (*v)[d] = number_in(json.at(k++));
  return s;
}

/// Lets @p action read the head, which is the same on every rank, and refuses the checkpoint if it
/// is not what it should be.
template <typename Action>
void understand(const Checkpoint &checkpoint, const Action &action)
{
  try {
    action(checkpoint.head);
  } catch (const nlohmann::json::exception &) {
    throw checkpoint.damaged("its head lacks what the case needs.");
  } catch (const std::invalid_argument &) {
    throw checkpoint.damaged("a number in its head is none.");
  }
}

} // namespace

void Simulation::find_checkpoint(Problems &problems)
{
  const RestartParameters &p = parameters.restart;
  if (p.restart == "false")
    return;
  std::vector<std::string> defects;
  checkpoint = checkpoints.open_newest(defects);
  if (!checkpoint) {
    if (p.restart == "true")
      problems.add("subsection 'restart' / entry 'restart'",
                   "is true, but " + parameters.control.output_path + " holds no checkpoint '" +
                       p.filename + "'.",
                   "Check 'output path' and 'filename', or set restart = auto to start anew where "
                   "there is none.");
    return;
  }
  for (const std::string &defect : defects)
    log.warning(defect);
  const Json &head = checkpoint->head;
  if (!head.contains("input") || !head["input"].is_string())
    throw checkpoint->damaged("it does not hold the input of its run.");
  find_input_differences(parameters.as_input_file(), head["input"], checkpoint->path, problems);
  const unsigned long long last = parameters.control.n_steps();
  understand(*checkpoint, [&](const Json &of_run) {
    if (count_in(of_run.at("step")) > last)
      problems.add("The checkpoint " + checkpoint->path,
                   "is of step " + std::to_string(count_in(of_run.at("step"))) +
                       ", and the run ends at step " + std::to_string(last) + ".",
                   "Raise 'time end' or 'iteration end', or start anew with 'restart = false'.");
  });
}

void Simulation::save(CheckpointWriter &writer)
{
  complete_step();
  Json &head = writer.head;
  head["step"] = step;
  head["next_id"] = ids.next();
  head["next_output"] = next_output;
  head["insertions"] = n_insertions;
  head["inserted"] = to_json(ledger.inserted.global(comm));
  head["taken_out"] = to_json(ledger.taken_out.global(comm));
  head["lost"] = to_json(ledger.lost.global(comm));
  head["through_outlet"] = Json::array();
  for (const Tally &tally : ledger.through_outlet)
    head["through_outlet"].push_back(to_json(tally.global(comm)));
  head["solids_at_search"] = Json::array();
  for (const RigidState &state : solids_at_search)
    head["solids_at_search"].push_back(to_json(state));
  if (domain.moves())
    head["mesh_at_search"] = to_json(domain.earlier_pose());
  if (sparse.is_enabled()) {
    Json &look = head["last_look"];
    look["time"] = last_look.time;
    for (const RigidState &state : last_look.solids)
      look["solids"].push_back(to_json(state));
  }
  system.save(writer);
  if (const Process *const process = parameters.process())
    process->save(writer);
}

void Simulation::resume_output()
{
  understand(*checkpoint, [&](const Json &head) { output.resume(head.at("output")); });
}

void Simulation::resume()
{
  checkpoints.go_on();
  understand(*checkpoint, [&](const Json &head) {
    take_over(head);
    domain.return_to_earlier_pose();
    system.load(*checkpoint, solids, parameters.load_balancing, sparse);
    n_particles = system.n_global();
    if (Process *const process = parameters.process())
      process->resume(*this, *checkpoint);
    const auto remembered = head.find("observables");
    if (remembered != head.end())
      for (const auto &[name, observable] : observable_list)
        if (remembered->contains(name))
          observable->resume(remembered->at(name));
  });
  move_solids();
  log.line("Continuing from " + checkpoint->path + ": step " + std::to_string(step) +
           ", t = " + format(present_time) + " s, " + std::to_string(n_particles) + " particles");
  checkpoint.reset();
}

void Simulation::take_over(const Json &head)
{
  step = first_step = count_in(head.at("step"));
  present_time = static_cast<double>(step) * parameters.control.time_step;
  ids.go_on_from(count_in<ParticleId>(head.at("next_id")));
  next_output = number_in(head.at("next_output"));
  n_insertions = count_in(head.at("insertions"));
  balanced_once = head.at("balanced_once");
  last_balance = count_in(head.at("last_balance"));
  ledger.inserted = to_tally(head.at("inserted"), comm);
  ledger.taken_out = to_tally(head.at("taken_out"), comm);
  ledger.lost = to_tally(head.at("lost"), comm);
  for (std::size_t o = 0; o < ledger.through_outlet.size(); ++o)
    ledger.through_outlet[o] = to_tally(head.at("through_outlet").at(o), comm);
  if (insertion)
    insertion->skip(n_insertions, count_in(head.at("inserted").at("number")));

  if (domain.moves())
    domain.set_earlier_pose(to_state(head.at("mesh_at_search")));
  solids_at_search.clear();
  for (std::size_t s = 0; s < solids.size(); ++s) {
    solids_at_search.push_back(to_state(head.at("solids_at_search").at(s)));
    solids[s].state = solids_at_search[s];
  }
  if (sparse.is_enabled()) {
    last_look.time = number_in(head.at("last_look").at("time"));
    for (std::size_t s = 0; s < solids.size(); ++s)
      last_look.solids.push_back(to_state(head.at("last_look").at("solids").at(s)));
  }
}

void Simulation::dump(const std::string &path)
{
  CheckpointWriter writer(comm);
  save(writer);
  writer.write(path);
}

void Simulation::checkpoint_if_due()
{
  const RestartParameters &p = parameters.restart;
  if (!p.checkpoint)
    return;
  // All ranks must agree on what only some know: the clock of the first, and signals.
  constexpr unsigned int steps_between_looks = 16;
  int wish[2] = {0, 0};
  if (step % steps_between_looks == 0) {
    wish[0] = stop_request::received();
    wish[1] = p.minutes > 0. && MPI_Wtime() - last_checkpoint > 60. * p.minutes ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, wish, 2, MPI_INT, MPI_MAX, comm);
  }
  stopped = wish[0] != 0;
  if (wish[1] == 0 && !stopped && (p.frequency == 0 || step % p.frequency != 0))
    return;
  const Timers::Scope scope(timers, Section::output);
  CheckpointWriter writer(comm);
  save(writer);
  // What depends on how the work is shared out has no place in a dump.
  writer.head["balanced_once"] = balanced_once;
  writer.head["last_balance"] = last_balance;
  writer.head["input"] = parameters.as_input_file();
  for (const auto &[name, observable] : observable_list) {
    Json remembered;
    observable->save(remembered);
    if (!remembered.is_null())
      writer.head["observables"][name] = remembered;
  }
  // After the observables, which may have held rows back.
  writer.head["output"] = output.save();
  output.sync();
  const std::string path = checkpoints.write(writer, step);
  last_checkpoint = MPI_Wtime();
  if (stopped)
    log.line("Asked to stop by signal " + std::to_string(wish[0]) + " at step " +
             std::to_string(step) + ". The run continues from " + path +
             " with 'restart = true' in subsection 'restart'.");
}

} // namespace eunoe
