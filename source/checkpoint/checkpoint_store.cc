#include <eunoe/checkpoint/checkpoint_store.h>
#include <eunoe/core/files.h>
#include <eunoe/core/problems.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace eunoe {

namespace fs = std::filesystem;

namespace {

const std::string ending = ".checkpoint";

bool is_first(MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  return rank == 0;
}

} // namespace

std::vector<std::string> CheckpointStore::listed() const
{
  std::vector<std::string> names;
  std::ifstream stream(index());
  for (std::string line; std::getline(stream, line);)
    if (!line.empty() && line.find('/') == std::string::npos)
      names.push_back(line);
  return names;
}

std::string CheckpointStore::latest() const
{
  std::string path;
  if (is_first(comm)) {
    const std::vector<std::string> names = listed();
    if (!names.empty())
      path = folder + "/" + names.front();
  }
  int size = static_cast<int>(path.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  path.resize(size);
  MPI_Bcast(path.data(), size, MPI_CHAR, 0, comm);
  return path;
}

void CheckpointStore::go_on()
{
  files = listed();
}

void CheckpointStore::remove_all_but(const std::vector<std::string> &names) const
{
  std::error_code failure;
  for (const auto &entry : fs::directory_iterator(folder, failure)) {
    const std::string file = entry.path().filename().string();
    const std::size_t digits = name.size() + 1;
    const bool is_ours = file.size() > digits + ending.size() &&
                         file.compare(0, digits, name + "_") == 0 &&
                         file.compare(file.size() - ending.size(), ending.size(), ending) == 0 &&
                         std::all_of(file.begin() + static_cast<std::ptrdiff_t>(digits),
                                     file.end() - static_cast<std::ptrdiff_t>(ending.size()),
                                     [](char c) { return c >= '0' && c <= '9'; });
    if (is_ours && std::find(names.begin(), names.end(), file) == names.end())
      remove_file(entry.path().string());
  }
}

std::string CheckpointStore::write(CheckpointWriter &writer, const unsigned long long step)
{
  char number[32];
  std::snprintf(number, sizeof number, "_%012llu", step);
  const std::string file = name + number + ending;
  writer.write(folder + "/" + file);
  int ok = 1;
  if (is_first(comm)) {
    files.erase(std::remove(files.begin(), files.end(), file), files.end());
    files.insert(files.begin(), file);
    if (files.size() > keep)
      files.resize(keep);
    std::string text;
    for (const std::string &each : files)
      text += each + "\n";
    try {
      write_file(index(), text);
      remove_all_but(files);
    } catch (const UserError &) {
      ok = 0;
    }
  }
  MPI_Bcast(&ok, 1, MPI_INT, 0, comm);
  if (ok == 0)
    throw UserError(index() + " cannot be written. Check the folder's permissions and the free "
                              "space.");
  return folder + "/" + file;
}

} // namespace eunoe
