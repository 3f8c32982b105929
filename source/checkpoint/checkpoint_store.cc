#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/checkpoint_store.h>
#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/new_file.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace eunoe {

namespace fs = std::filesystem;

namespace {

const std::string ending = ".checkpoint";

/// First line of an index whose other lines name the checkpoints of an earlier run.
const std::string anew = "begun anew; of the run before:";

/// When a file was written, for people; collective.
std::string time_of(const std::string &path, MPI_Comm comm)
{
  std::string text;
  if (is_first_rank(comm)) {
    std::error_code failure;
    const auto age = fs::file_time_type::clock::now() - fs::last_write_time(path, failure);
    const std::time_t written =
        std::time(nullptr) -
        static_cast<std::time_t>(std::chrono::duration_cast<std::chrono::seconds>(age).count());
    char time[32];
    std::strftime(time, sizeof time, "%Y-%m-%d %H:%M:%S", std::localtime(&written));
    text = time;
  }
  return broadcast(text, comm);
}

} // namespace

bool CheckpointStore::is_ours(const std::string &file) const
{
  const std::size_t digits = name.size() + 1;
  return file.size() > digits + ending.size() && file.compare(0, digits, name + "_") == 0 &&
         file.compare(file.size() - ending.size(), ending.size(), ending) == 0 &&
         std::all_of(file.begin() + static_cast<std::ptrdiff_t>(digits),
                     file.end() - static_cast<std::ptrdiff_t>(ending.size()),
                     [](char c) { return c >= '0' && c <= '9'; });
}

CheckpointStore::Index CheckpointStore::read_index() const
{
  std::ifstream stream(index(), std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::istringstream lines(text);
  Index found;
  for (std::string line; std::getline(lines, line);)
    if (line == anew && found.names.empty())
      found.begun_anew = true;
    else
      found.names.push_back(line);
  // An index that is not in order may have lost any of its lines.
  const bool is_in_order = !text.empty() && text.back() == '\n' &&
                           std::all_of(found.names.begin(), found.names.end(),
                                       [this](const std::string &file) { return is_ours(file); });
  return is_in_order ? found : Index();
}

std::vector<std::string> CheckpointStore::present() const
{
  std::vector<std::string> names;
  std::error_code failure;
  for (const auto &entry : fs::directory_iterator(folder, failure))
    if (is_ours(entry.path().filename().string()))
      names.push_back(entry.path().filename().string());
  // Numbers of steps have leading zeros, and a longer one is larger.
  std::sort(names.begin(), names.end(), [](const std::string &a, const std::string &b) {
    return a.size() != b.size() ? a.size() > b.size() : a > b;
  });
  return names;
}

std::vector<std::string> CheckpointStore::candidates() const
{
  const Index listed = read_index();
  std::vector<std::string> found;
  if (!listed.begun_anew)
    found = listed.names;
  for (const std::string &file : present())
    if (std::find(listed.names.begin(), listed.names.end(), file) == listed.names.end())
      found.push_back(file);
  return found;
}

bool CheckpointStore::was_begun_anew() const
{
  return broadcast(is_first_rank(comm) && read_index().begun_anew ? "yes" : "", comm) == "yes";
}

void CheckpointStore::begin_anew()
{
  on_first_rank(comm, [&] {
    std::string text = anew + "\n";
    const std::vector<std::string> all = present();
    for (const std::string &each : all)
      text += each + "\n";
    if (!all.empty())
      write_file(index(), text, true);
    else // Those that it names are gone, for which a run that goes on would be refused.
      remove_file(index());
  });
}

std::vector<std::string> CheckpointStore::find(std::string &defect)
{
  std::string names, problem;
  on_first_rank(comm, [&] {
    std::error_code failure;
    if (read_index().names.empty()) {
      // A run that begins anew as it sees nothing might do so over the results of another.
      const fs::directory_iterator look(folder, failure);
      if (failure && failure != std::errc::no_such_file_or_directory)
        throw UserError("The checkpoints in " + folder + " cannot be looked for: " +
                        failure.message() + ". Check the name of the folder and its permissions.");
      if (fs::exists(index(), failure))
        problem = index() + " is empty or damaged.";
      else if (!present().empty())
        problem = index() + ", which names the checkpoints, is missing.";
    }
    for (const std::string &file : candidates())
      names += file + "\n";
  });
  defect = broadcast(problem, comm);
  std::istringstream lines(broadcast(names, comm));
  std::vector<std::string> found;
  for (std::string line; std::getline(lines, line);)
    found.push_back(line);
  newest = found.empty() ? "" : found.front();
  return found;
}

bool CheckpointStore::has_gone_on() const
{
  std::string now;
  if (is_first_rank(comm))
    if (const std::vector<std::string> found = candidates(); !found.empty())
      now = found.front();
  return broadcast(now, comm) != newest;
}

std::unique_ptr<Checkpoint> CheckpointStore::open_newest(std::vector<std::string> &defects)
{
  std::string defect;
  earlier = find(defect);
  if (!defect.empty())
    defects.push_back(defect);
  while (!earlier.empty()) {
    const std::string path = folder + "/" + earlier.front();
    try {
      auto checkpoint = std::make_unique<Checkpoint>(path, comm);
      if (!defects.empty())
        defects.push_back("The newest checkpoint that is whole is " + path + ", written on " +
                          time_of(path, comm) + "; the run continues from there.");
      return checkpoint;
    } catch (const DamagedCheckpoint &error) {
      defects.push_back(error.what());
      earlier.erase(earlier.begin());
    }
  }
  if (defects.empty())
    return nullptr;
  std::string text;
  for (const std::string &each : defects)
    text += each + " ";
  throw UserError(
      text + "So " + folder + " holds no checkpoint '" + name +
      "' that is whole, and nothing in it was touched. Put one back, or start anew with "
      "'restart = false'.");
}

void CheckpointStore::keep_opened()
{
  on_first_rank(comm, [&] {
    const std::string from = folder + "/" + earlier.front();
    const std::string to = folder + "/" + name + "_phase" + earlier.front().substr(name.size());
    std::error_code failure;
    if (fs::equivalent(from, to, failure))
      return;
    // What another run kept under this name gives way when this one is complete.
    const std::string beside = to + ".new";
    fs::remove(beside, failure);
    fs::create_hard_link(from, beside, failure);
    if (failure) {
      fs::copy_file(from, beside, failure);
      if (!failure)
        sync_file(beside);
    }
    if (!failure)
      fs::rename(beside, to, failure);
    if (failure) {
      std::error_code ignored;
      fs::remove(beside, ignored);
      throw UserError(cannot_be_written(to, failure.message()));
    }
  });
}

void CheckpointStore::go_on()
{
  files = earlier;
}

/// Removes what is left of a checkpoint in the writing of which a run was killed.
void CheckpointStore::remove_unfinished() const
{
  const std::string unfinished = ".new";
  std::error_code failure;
  for (const auto &entry : fs::directory_iterator(folder, failure)) {
    const std::string file = entry.path().filename().string();
    if (fs::is_regular_file(entry.symlink_status(failure)) && file.size() > unfinished.size() &&
        file.compare(file.size() - unfinished.size(), std::string::npos, unfinished) == 0 &&
        is_ours(file.substr(0, file.size() - unfinished.size())))
      remove_file(entry.path().string());
  }
}

std::string CheckpointStore::write(CheckpointWriter &writer, const unsigned long long step)
{
  char number[32];
  std::snprintf(number, sizeof number, "_%012llu", step);
  const std::string file = name + number + ending;
  on_first_rank(comm, [&] { remove_unfinished(); });
  writer.write(folder + "/" + file);
  on_first_rank(comm, [&] {
    files.erase(std::remove(files.begin(), files.end(), file), files.end());
    files.insert(files.begin(), file);
    if (files.size() > keep)
      files.resize(keep);
    std::string text;
    for (const std::string &each : files)
      text += each + "\n";
    write_file(index(), text, true);
    for (const std::string &each : present())
      if (std::find(files.begin(), files.end(), each) == files.end())
        remove_file(folder + "/" + each);
  });
  return folder + "/" + file;
}

} // namespace eunoe
