#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/head_values.h>
#include <eunoe/checkpoint/input_differences.h>
#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/input_file.h>
#include <eunoe/core/log.h>
#include <eunoe/core/named_files.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/stop_request.h>
#include <eunoe/simulation/checkpoints.h>
#include <eunoe/simulation/control_parameters.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

namespace eunoe {

namespace {

namespace fs = std::filesystem;

/// Lines that say in what two inputs differ.
void tell_differences(const Problems &differences, const std::string &path, Log &log)
{
  constexpr std::size_t most = 40;
  const std::string end = " in the run that wrote " + path + ".";
  std::vector<std::string> lines;
  std::size_t n_one_sided = 0;
  for (const Problem &difference : differences.all()) {
    // Of a section that only one of them has, there would be many.
    if (difference.what.compare(0, 7, "is set,") == 0 ||
        difference.what.compare(0, 11, "is missing,") == 0 || difference.what.size() < end.size())
      ++n_one_sided;
    else
      lines.push_back("  " + difference.where + " " +
                      difference.what.substr(0, difference.what.size() - end.size()));
  }
  const std::size_t n_more = n_one_sided + lines.size() - std::min(most, lines.size());
  log.line("Going on from " + path + " with another input. What differs:");
  for (std::size_t k = 0; k < std::min(most, lines.size()); ++k)
    log.line(lines[k]);
  if (n_more > 0)
    log.line("  and " + std::to_string(n_more) +
             " more entries, most of which only one of them has");
}

/// Whether two paths mean one folder, however they are written.
bool is_same_folder(const std::string &a, const std::string &b)
{
  const auto canonical = [](const std::string &path) {
    std::error_code error;
    const fs::path found = fs::weakly_canonical(fs::path(path) / "", error);
    return error ? fs::path(path) : found;
  };
  return a == b || canonical(a) == canonical(b);
}

/// Time of a checkpoint (s).
double time_in(const nlohmann::ordered_json &clock)
{
  return number_in(clock.at("begin_time")) +
         static_cast<double>(count_in(clock.at("step")) - count_in(clock.at("begin_step"))) *
             number_in(clock.at("time_step"));
}

} // namespace

Checkpoints::Checkpoints(const RestartParameters &parameters, const std::string &output_path,
                         MPI_Comm comm)
    : parameters(parameters), folder(parameters.place(output_path)), comm(comm),
      store(folder, parameters.name(), parameters.keep, comm)
{
}

Checkpoints::~Checkpoints() = default;

void Checkpoints::close()
{
  checkpoint.reset();
}

std::vector<std::string> Checkpoints::folders_nearby() const
{
  std::set<std::string> found;
  std::string text;
  if (is_first_rank(comm)) {
    std::error_code failure;
    const fs::path own = (fs::absolute(folder, failure) / "").lexically_normal().parent_path();
    for (const fs::path &place : {fs::path("."), own.parent_path()}) {
      if (CheckpointStore(place.string(), parameters.name(), 1, MPI_COMM_SELF).has_any())
        found.insert(fs::canonical(place, failure).string());
      for (const auto &entry : fs::directory_iterator(place, failure)) {
        const std::string path = entry.path().lexically_normal().string();
        if (entry.is_directory(failure) && !fs::equivalent(entry.path(), own, failure) &&
            CheckpointStore(path, parameters.name(), 1, MPI_COMM_SELF).has_any())
          found.insert(fs::canonical(entry.path(), failure).string());
      }
    }
    for (const std::string &path : found)
      text += path + "\n";
  }
  std::istringstream lines(broadcast(text, comm));
  std::vector<std::string> folders;
  for (std::string line; std::getline(lines, line);)
    folders.push_back(line);
  return folders;
}

void Checkpoints::open(Log &log)
{
  std::vector<std::string> defects;
  checkpoint = store.open_newest(defects);
  std::vector<std::string> others;
  if (!checkpoint && !parameters.folder.empty())
    others = {parameters.folder};
  else if (!checkpoint && parameters.restart == "true" && !store.was_begun_anew())
    others = folders_nearby();
  if (others.size() > 1) {
    std::string list;
    for (const std::string &other : others)
      list += (list.empty() ? "" : ", ") + other;
    throw UserError("subsection 'restart' / entry 'restart' is true, and checkpoints '" +
                    parameters.name() + "' are in several folders: " + list +
                    ". Name one as 'restart folder'.");
  }
  if (others.size() == 1) {
    CheckpointStore other(others[0], parameters.name(), 1, comm);
    checkpoint = other.open_newest(defects);
    is_own_folder = checkpoint == nullptr;
  }
  if (checkpoint)
    for (const std::string &defect : defects)
      log.warning(defect);
}

void Checkpoints::find(const EntryValues &input, const EntryValues &changed,
                       const EntryValues &naming_files, const ControlParameters &control,
                       const PhaseJudge &judge, Log &log, Problems &problems)
{
  if (parameters.checkpoint || parameters.restart != "false")
    files = named_files(naming_files, comm);
  if (parameters.restart == "false")
    return;
  open(log);
  if (!checkpoint) {
    if (parameters.restart == "true" && parameters.folder.empty() && store.was_begun_anew())
      problems.add(
          "subsection 'restart' / entry 'restart'",
          "is true, but the run that began anew in " + folder +
              " was stopped before its first checkpoint.",
          "Start it again with 'restart = false' or 'auto'. Checkpoints of the run before it "
          "are still there: without " +
              store.index() +
              " a run with another 'output path' goes on from them by 'restart folder'.");
    else if (parameters.restart == "true" || !parameters.folder.empty())
      problems.add("subsection 'restart' / entry 'restart'",
                   "is " + parameters.restart + ", but " +
                       (parameters.folder.empty() ? folder : parameters.folder) +
                       " holds no checkpoint '" + parameters.name() + "'.",
                   parameters.folder.empty()
                       ? "Check 'output path' and 'filename', or set restart = auto to start anew "
                         "where there is none."
                       : "Check 'restart folder' and 'filename', or leave 'restart folder' out.");
    return;
  }
  const nlohmann::ordered_json &head = checkpoint->head;
  if (!head.contains("input") || !head["input"].is_string())
    throw checkpoint->damaged("it does not hold the input of its run.");
  Problems differences;
  EntryValues entries = values_in(head["input"]);
  find_input_differences(input, entries, changed, checkpoint->path, differences);
  // Those of older versions do not know the files of their run.
  if (head.contains("files"))
    understand([&](const nlohmann::ordered_json &of_run) {
      find_file_differences(files, of_run.at("files").get<EntryValues>(), checkpoint->path,
                            differences);
    });
  // Where checkpoints have a path of their own, the results may lie elsewhere.
  has_own_results =
      is_own_folder &&
      (is_same_folder(folder, control.output_path) ||
       is_same_folder(entries[{{"simulation control"}, "output path"}], control.output_path));
  if (parameters.restart == "auto" && is_own_folder)
    for (const Problem &difference : differences.all())
      problems.add(difference.where, difference.what, difference.mend);
  else if (!differences.empty()) {
    is_other_input = true;
    understand([&](const nlohmann::ordered_json &of_run) { judge(differences, of_run, problems); });
    tell_differences(differences, checkpoint->path, log);
  }
  understand([&](const nlohmann::ordered_json &of_run) {
    const auto step = count_in(of_run.at("clock").at("step"));
    last_step = step;
    const double time = time_in(of_run.at("clock"));
    const nlohmann::ordered_json &clock = of_run.at("clock");
    const unsigned long long last = is_other_input
                                        ? control.last_step(step, time)
                                        : control.last_step(count_in(clock.at("begin_step")),
                                                            number_in(clock.at("begin_time")));
    const bool by_time = is_other_input && control.end_control == "time";
    if (step > last || (is_other_input && step == last))
      problems.add("The checkpoint " + checkpoint->path,
                   "is of step " + std::to_string(step) +
                       (by_time ? ", t = " + format(time) + " s" : "") + ", and the run ends at " +
                       (by_time ? "t = " + format(control.time_end) + " s."
                                : "step " + std::to_string(last) + "."),
                   "Raise 'time end' or 'iteration end', or start anew with 'restart = false'.");
  });
}

double Checkpoints::time() const
{
  double time = 0.;
  understand([&](const nlohmann::ordered_json &head) { time = time_in(head.at("clock")); });
  return time;
}

void Checkpoints::understand(
    const std::function<void(const nlohmann::ordered_json &)> &action) const
{
  try {
    action(checkpoint->head);
  } catch (const nlohmann::json::exception &) {
    throw checkpoint->damaged("its head lacks what the case needs.");
  } catch (const std::invalid_argument &) {
    throw checkpoint->damaged("a number in its head is none.");
  }
}

std::string Checkpoints::occupy()
{
  if (!parameters.checkpoint)
    return "";
  create_folder(folder, comm);
  const std::string path = (fs::path(folder) / parameters.name()).string();
  lock = std::make_unique<RunLock>(
      path + ".lock", "The place of the checkpoints " + shortened(path),
      "Wait until it ends, or stop it, or choose another 'filename' in subsection 'restart'.",
      comm);
  return lock->weakness();
}

void Checkpoints::check_newest() const
{
  if (parameters.restart != "false" && store.has_gone_on())
    throw UserError("The run in " + folder +
                    " went on after this one had looked for its newest checkpoint: start again.");
}

void Checkpoints::begin()
{
  if (parameters.checkpoint) {
    create_folder(folder, comm);
    stop_request::listen();
  }
  last_time = MPI_Wtime();
}

bool Checkpoints::is_due(const unsigned long long step)
{
  const RestartParameters &p = parameters;
  if (!p.checkpoint)
    return false;
  // All ranks must agree on what only some know: the clock of the first, and signals.
  constexpr unsigned int steps_between_looks = 16;
  int wish[2] = {0, 0};
  if (step % steps_between_looks == 0) {
    wish[0] = stop_request::received();
    wish[1] = p.minutes > 0. && MPI_Wtime() - last_time > 60. * p.minutes ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, wish, 2, MPI_INT, MPI_MAX, comm);
  }
  signal = wish[0];
  return wish[1] != 0 || signal != 0 || (p.frequency > 0 && step % p.frequency == 0);
}

void Checkpoints::write(CheckpointWriter &writer, const unsigned long long step, Log &log)
{
  writer.head["files"] = files;
  const std::string path = store.write(writer, step);
  last_step = step;
  last_time = MPI_Wtime();
  if (signal != 0)
    log.line("Asked to stop by signal " + std::to_string(signal) + " at step " +
             std::to_string(step) + ". The run continues from " + path +
             " with 'restart = true' in subsection 'restart'.");
}

} // namespace eunoe
