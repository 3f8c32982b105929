#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/new_file.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/shared_file.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace eunoe {

namespace fs = std::filesystem;

std::string broadcast(std::string text, MPI_Comm comm, const int from)
{
  unsigned long long size = text.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, from, comm);
  text.resize(size);
  constexpr unsigned long long part = 1u << 30;
  for (unsigned long long first = 0; first < size; first += part)
    MPI_Bcast(&text[first], static_cast<int>(std::min(part, size - first)), MPI_CHAR, from, comm);
  return text;
}

namespace {

[[noreturn]] void refuse(const std::string &path, const std::string &why)
{
  throw UserError(shortened(path) + " cannot be read: " + why +
                  ". Check the name and the permissions.");
}

} // namespace

std::ifstream open_for_reading(const std::string &path)
{
  std::error_code failure; // which opening the file tells
  if (fs::is_directory(path, failure))
    refuse(path, "it is a folder");
  if (fs::is_character_file(path, failure) || fs::is_block_file(path, failure))
    refuse(path, "it is a device"); // of which some never end
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    refuse(path, std::strerror(errno));
  return stream;
}

std::string read_file(const std::string &path, MPI_Comm comm)
{
  std::string text;
  on_first_rank(comm, [&] {
    std::ifstream stream = open_for_reading(path);
    if (stream.peek() == std::ifstream::traits_type::eof())
      return;
    std::ostringstream all;
    all << stream.rdbuf();
    text = all.str();
    if (!stream)
      refuse(path, "reading failed");
  });
  return broadcast(text, comm);
}

void write_file(const std::string &path, const std::string &text, const bool sync)
{
  NewFile file(path);
  file.write(text.data(), text.size());
  file.complete(sync);
}

void write_in_parts(const std::string &path, const std::string &mine, MPI_Comm comm)
{
  const std::uint64_t n = mine.size();
  std::uint64_t end = 0;
  MPI_Scan(&n, &end, 1, MPI_UINT64_T, MPI_SUM, comm);
  SharedFile file(path, comm);
  file.write(end - n, mine.data(), n);
  file.complete(false);
}

double file_size(const std::string &path)
{
  std::error_code failure;
  const auto size = fs::file_size(path, failure);
  return failure ? 0. : static_cast<double>(size);
}

void remove_file(const std::string &path)
{
  std::error_code failure;
  fs::remove(path, failure);
}

void create_folder(const std::string &path, MPI_Comm comm)
{
  on_first_rank(comm, [&] {
    std::error_code failure;
    std::string error;
    fs::create_directories(path, failure);
    const std::string probe = path + "/.eunoe-probe";
    if (failure)
      error = failure.message();
    else if (!std::ofstream(probe))
      error = std::strerror(errno);
    fs::remove(probe, failure);
    if (!error.empty())
      throw UserError("The folder " + shortened(path) + " cannot be written to: " + error +
                      ". Choose another folder, or mend the permissions.");
  });
}

} // namespace eunoe
