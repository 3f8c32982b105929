#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/head_values.h>
#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/messages.h>

#include "format.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <numeric>

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
    throw DamagedCheckpoint("The checkpoint " + path + " " + what);
  }

  void read(void *data, std::uint64_t n)
  {
    if (n > 0 && std::fread(data, 1, n, stream) != n)
      refuse("cannot be read: " + std::string(std::strerror(errno)) + ".");
  }

  /// @return the head
  std::string open()
  {
    if (stream == nullptr) {
      const bool is_missing = errno == ENOENT;
      const std::string text = "cannot be read: " + std::string(std::strerror(errno)) + ".";
      if (is_missing)
        refuse(text);
      throw UserError("The checkpoint " + path + " " + text + " Mend its permissions.");
    }
    std::error_code failure;
    size = std::filesystem::file_size(path, failure);
    if (failure || size < format_name.size() + 2 + 2 * sizeof(std::uint64_t))
      refuse("is cut short: it has " + std::to_string(size) + " bytes.");
    const bool is_whole = has_its_checksum();
    std::string title(format_name.size(), ' ');
    std::fseek(stream, 0, SEEK_SET);
    read(title.data(), title.size());
    if (title != format_name)
      refuse("is no checkpoint of Eunoe.");
    std::string version;
    for (int c = std::fgetc(stream); c != '\n' && version.size() < 20; c = std::fgetc(stream))
      version += c >= ' ' && c <= '~' ? static_cast<char>(c) : '?';
    if (version != format_version) {
      const std::string text = "The checkpoint " + path + " has version " + version +
                               " of the format, and this program reads version " + format_version;
      if (is_whole)
        throw UserError(text + ". Use the program that wrote it, or start anew.");
      throw DamagedCheckpoint(text + ", or it is damaged.");
    }
    if (!is_whole)
      refuse("is cut short or damaged: its checksum does not fit.");
    std::uint64_t length;
    read(&length, sizeof length);
    if (length > size - title.size() - version.size() - 1 - 2 * sizeof(std::uint64_t))
      refuse("is damaged: its head does not fit into it.");
    std::string text(length, ' ');
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

  /// Reads everything once.
  bool has_its_checksum()
  {
    Checksum checksum;
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
    return sum == checksum.checksum();
  }

  const std::string path;
  std::FILE *stream;
  std::uint64_t size = 0;
  std::map<std::string, Section> sections;
};

Checkpoint::Checkpoint(const std::string &path, MPI_Comm comm) : path(path), comm(comm)
{
  std::string text, error;
  int is_damaged = 0;
  if (is_first_rank(comm))
    try {
      file = std::make_unique<File>(path);
      text = file->open();
      const auto begin = static_cast<std::uint64_t>(std::ftell(file->stream));
      file->find_sections(nlohmann::ordered_json::parse(text).at("sections"), begin);
    } catch (const DamagedCheckpoint &problem) {
      error = problem.what();
      is_damaged = 1;
    } catch (const UserError &problem) {
      error = problem.what();
    } catch (const std::exception &) {
      // Of JSON, or of a value in it.
      error = "The checkpoint " + path + " is damaged: its head is not understood.";
      is_damaged = 1;
    }
  MPI_Bcast(&is_damaged, 1, MPI_INT, 0, comm);
  error = broadcast(error, comm);
  if (is_damaged != 0)
    throw DamagedCheckpoint(error);
  if (!error.empty())
    throw UserError(error);
  head = nlohmann::ordered_json::parse(broadcast(text, comm));
}

Checkpoint::~Checkpoint() = default;

UserError Checkpoint::damaged(const std::string &what) const
{
  return UserError(
      "The checkpoint " + path + " is damaged: " + what +
      " Move it away to go on from an older one, or start anew with 'restart = false'.");
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

  const auto take = [](const std::vector<std::uint32_t> &lengths, std::vector<double> values) {
    Rows rows;
    rows.starts.assign(lengths.size() + 1, 0);
    std::partial_sum(lengths.begin(), lengths.end(), rows.starts.begin() + 1,
                     [](std::size_t sum, std::uint32_t n) { return sum + n; });
    rows.values = std::move(values);
    return rows;
  };
  const auto number_of_values = [](const std::vector<std::uint32_t> &lengths) {
    return std::accumulate(lengths.begin(), lengths.end(), std::uint64_t(0));
  };

  std::vector<std::vector<std::uint32_t>> lengths(n_ranks);
  on_first_rank(comm, [&] {
    const auto section = file->sections.find(name);
    if (section == file->sections.end())
      throw UserError("The checkpoint " + path + " has no section '" + name + "'.");
    std::fseek(file->stream, static_cast<long>(section->second.begin), SEEK_SET);
    std::uint64_t sum = 0;
    for (int r = 0; r < n_ranks; ++r) {
      lengths[r].resize(share(r));
      file->read(lengths[r].data(), lengths[r].size() * sizeof(std::uint32_t));
      sum += number_of_values(lengths[r]);
    }
    if (sum != section->second.n_values)
      file->refuse("is damaged: the rows of '" + name + "' do not fill their section.");
  });
  if (rank > 0) {
    lengths[rank].resize(share(rank));
    receive(lengths[rank].data(), lengths[rank].size() * sizeof(std::uint32_t), 0, tag_lengths,
            comm);
    std::vector<double> values(number_of_values(lengths[rank]));
    receive(values.data(), values.size() * sizeof(double), 0, tag_values, comm);
    return take(lengths[rank], std::move(values));
  }
  Rows mine;
  for (int r = 0; r < n_ranks; ++r) {
    std::vector<double> values(number_of_values(lengths[r]));
    file->read(values.data(), values.size() * sizeof(double));
    if (r == 0) {
      mine = take(lengths[0], std::move(values));
      continue;
    }
    send(lengths[r].data(), lengths[r].size() * sizeof(std::uint32_t), r, tag_lengths, comm);
    send(values.data(), values.size() * sizeof(double), r, tag_values, comm);
  }
  return mine;
}

} // namespace eunoe
