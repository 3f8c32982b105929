#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/head_values.h>

#include "format.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <numeric>
#include <stdexcept>

namespace eunoe {

using namespace checkpoint_format;

/// The file on the first rank, with the places of the sections.
struct Checkpoint::File
{
  struct Section
  {
    std::uint64_t begin, n_rows, n_values; ///< begin: place of the lengths (bytes)
  };

  explicit File(const std::string &path) : path(path), stream(std::fopen(path.c_str(), "rb")) {}
  ~File()
  {
    if (stream != nullptr)
      std::fclose(stream);
  }

  [[noreturn]] void refuse(const std::string &what) const
  {
    throw UserError("The checkpoint " + path + " " + what);
  }

  void read(void *data, std::uint64_t n)
  {
    if (n > 0 && std::fread(data, 1, n, stream) != n)
      refuse("cannot be read: " + std::string(std::strerror(errno)) + ".");
  }

  /// @return the head
  std::string open()
  {
    if (stream == nullptr)
      refuse("cannot be read: " + std::string(std::strerror(errno)) +
             ". Check the name, or start anew with 'restart = false'.");
    std::error_code failure;
    size = std::filesystem::file_size(path, failure);
    const std::string mend = " Take an older checkpoint, or start anew with 'restart = false'.";
    std::string title(format_name.size(), ' ');
    if (failure || size < title.size() + 2 + 2 * sizeof(std::uint64_t))
      refuse("is cut short: it has " + std::to_string(size) + " bytes." + mend);
    read(title.data(), title.size());
    if (title != format_name)
      refuse("is no checkpoint of Eunoe. Name another file.");
    std::string version;
    for (int c = std::fgetc(stream); c != '\n' && version.size() < 20; c = std::fgetc(stream))
      version += c >= ' ' && c <= '~' ? static_cast<char>(c) : '?';
    if (version != format_version)
      refuse("has version " + version + " of the format, and this program reads version " +
             format_version + ". Use the program that wrote it, or start anew.");
    std::uint64_t length;
    read(&length, sizeof length);
    verify(mend);
    if (length > size - title.size() - version.size() - 1 - 2 * sizeof(std::uint64_t))
      refuse("is damaged: its head does not fit into it." + mend);
    std::string text(length, ' ');
    std::fseek(stream, static_cast<long>(title.size() + version.size() + 1 + sizeof length),
               SEEK_SET);
    read(text.data(), length);
    return text;
  }

  /// Notes the places of the sections, which begin at @p begin and must fill the file.
  void find_sections(const nlohmann::ordered_json &list, std::uint64_t begin)
  {
    for (const auto &section : list) {
      const std::uint64_t n_rows = count_in(section.at("rows"));
      const std::uint64_t n_values = count_in(section.at("values"));
      const std::uint64_t left = size - sizeof(std::uint64_t) - begin;
      if (n_rows > left / sizeof(std::uint32_t) ||
          n_values > (left - n_rows * sizeof(std::uint32_t)) / sizeof(double))
        refuse("is damaged: its sections do not fit into it.");
      sections[section.at("name")] = {begin, n_rows, n_values};
      begin += n_rows * sizeof(std::uint32_t) + n_values * sizeof(double);
    }
    if (begin + sizeof(std::uint64_t) != size)
      refuse("is damaged: its sections do not fill it.");
  }

  /// Reads everything once for the checksum.
  void verify(const std::string &mend)
  {
    Checksum checksum;
    std::fseek(stream, 0, SEEK_SET);
    std::vector<char> part(1u << 20);
    std::uint64_t left = size - sizeof(std::uint64_t);
    while (left > 0) {
      const std::uint64_t n = std::min<std::uint64_t>(left, part.size());
      read(part.data(), n);
      checksum.process_bytes(part.data(), n);
      left -= n;
    }
    std::uint64_t sum;
    read(&sum, sizeof sum);
    if (sum != checksum.checksum())
      refuse("is cut short or damaged: its checksum does not fit." + mend);
  }

  const std::string path;
  std::FILE *stream;
  std::uint64_t size = 0;
  std::map<std::string, Section> sections;
};

Checkpoint::Checkpoint(const std::string &path, MPI_Comm comm) : path(path), comm(comm)
{
  std::string text, error;
  if (rank_in(comm) == 0)
    try {
      file = std::make_unique<File>(path);
      text = file->open();
      const auto begin = static_cast<std::uint64_t>(std::ftell(file->stream));
      file->find_sections(nlohmann::ordered_json::parse(text).at("sections"), begin);
    } catch (const UserError &problem) {
      error = problem.what();
    } catch (const std::exception &) {
      // Of JSON, or of a value in it.
      error = damaged("its head is not understood.").what();
    }
  agree(error, comm);
  std::uint64_t length = text.size();
  MPI_Bcast(&length, 1, MPI_UINT64_T, 0, comm);
  text.resize(length);
  MPI_Bcast(text.data(), static_cast<int>(length), MPI_CHAR, 0, comm);
  head = nlohmann::ordered_json::parse(text);
}

Checkpoint::~Checkpoint() = default;

UserError Checkpoint::damaged(const std::string &what) const
{
  return UserError("The checkpoint " + path + " is damaged: " + what +
                   " Take an older checkpoint, or start anew with 'restart = false'.");
}

void Checkpoint::require(const bool ok, const std::string &what) const
{
  int all = ok ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, comm);
  if (all == 0)
    throw damaged(what);
}

Rows Checkpoint::rows(const std::string &name) const
{
  const int n_ranks = size_of(comm), rank = rank_in(comm);
  std::uint64_t n_rows = 0;
  for (const auto &section : head.at("sections"))
    if (section.at("name") == name)
      n_rows = section.at("rows");
  const auto share = [&](int r) {
    return first_of(n_rows, r + 1, n_ranks) - first_of(n_rows, r, n_ranks);
  };

  std::string error;
  bool agreed = false;
  Rows mine;
  const auto keep = [&mine](const std::vector<std::uint32_t> &lengths, std::vector<double> values) {
    mine.starts.assign(lengths.size() + 1, 0);
    std::partial_sum(lengths.begin(), lengths.end(), mine.starts.begin() + 1,
                     [](std::size_t sum, std::uint32_t n) { return sum + n; });
    mine.values = std::move(values);
  };
  if (rank == 0) {
    try {
      const File::Section &section = file->sections.at(name);
      std::vector<std::vector<std::uint32_t>> lengths(n_ranks);
      std::fseek(file->stream, static_cast<long>(section.begin), SEEK_SET);
      std::uint64_t sum = 0;
      std::vector<std::uint64_t> n_values(n_ranks, 0);
      for (int r = 0; r < n_ranks; ++r) {
        lengths[r].resize(share(r));
        file->read(lengths[r].data(), lengths[r].size() * sizeof(std::uint32_t));
        n_values[r] = std::accumulate(lengths[r].begin(), lengths[r].end(), std::uint64_t(0));
        sum += n_values[r];
      }
      if (sum != section.n_values)
        file->refuse("is damaged: the rows of '" + name + "' do not fill their section.");
      agree("", comm);
      agreed = true;
      for (int r = 0; r < n_ranks; ++r) {
        std::vector<double> values(n_values[r]);
        file->read(values.data(), values.size() * sizeof(double));
        if (r == 0) {
          keep(lengths[0], std::move(values));
          continue;
        }
        send(lengths[r].data(), lengths[r].size() * sizeof(std::uint32_t), r, tag_lengths, comm);
        send(values.data(), values.size() * sizeof(double), r, tag_values, comm);
      }
      return mine;
    } catch (const std::out_of_range &) {
      error = "The checkpoint " + path + " has no section '" + name + "'.";
    } catch (const UserError &problem) {
      if (agreed)
        // The others wait for data that will not come.
        throw std::runtime_error(problem.what());
      error = problem.what();
    }
  }
  agree(error, comm);
  std::vector<std::uint32_t> lengths(share(rank));
  receive(lengths.data(), lengths.size() * sizeof(std::uint32_t), 0, tag_lengths, comm);
  std::vector<double> values(std::accumulate(lengths.begin(), lengths.end(), std::uint64_t(0)));
  receive(values.data(), values.size() * sizeof(double), 0, tag_values, comm);
  keep(lengths, std::move(values));
  return mine;
}

} // namespace eunoe
