#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/head_values.h>
#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>

#include "format.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <numeric>

namespace eunoe {

using namespace checkpoint_format;

/// The file, with the places of the sections.
struct Checkpoint::File
{
  struct Section
  {
    std::uint64_t begin, n_rows, n_values; ///< begin: place of the lengths (bytes)
  };

  File(const std::string &path, MPI_Comm comm)
      : path(path), comm(comm), stream(std::fopen(path.c_str(), "rb")),
        open_error(stream == nullptr ? errno : 0)
  {
  }
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

  void read_at(std::uint64_t begin, void *data, std::uint64_t n)
  {
    std::fseek(stream, static_cast<long>(begin), SEEK_SET);
    read(data, n);
  }

  void require_open()
  {
    if (stream == nullptr) {
      const std::string text = "cannot be read: " + std::string(std::strerror(open_error)) + ".";
      if (open_error == ENOENT && is_first_rank(comm))
        refuse(text);
      if (open_error == ENOENT)
        throw UserError("The checkpoint " + path +
                        " is not seen by every node. Put it into a folder that all share.");
      throw UserError("The checkpoint " + path + " " + text + " Mend its permissions.");
    }
    std::error_code failure;
    size = std::filesystem::file_size(path, failure);
    if (failure || size < format_name.size() + 2 + 2 * sizeof(std::uint64_t))
      refuse("is cut short: it has " + std::to_string(size) + " bytes.");
  }

  /// @param is_whole whether the checksum fits
  /// @return the head
  std::string head(const bool is_whole)
  {
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

  /// The checksum of this rank's share of the file.
  Checksum checksum_of_share()
  {
    const std::uint64_t n = size - sizeof(std::uint64_t);
    const int rank = rank_in(comm), n_ranks = size_of(comm);
    std::uint64_t left = first_of(n, rank + 1, n_ranks) - first_of(n, rank, n_ranks);
    std::fseek(stream, static_cast<long>(first_of(n, rank, n_ranks)), SEEK_SET);
    Checksum checksum;
    std::vector<char> part(1u << 20);
    while (left > 0) {
      const std::uint64_t here = std::min<std::uint64_t>(left, part.size());
      read(part.data(), here);
      checksum.add(part.data(), here);
      left -= here;
    }
    return checksum;
  }

  const std::string path;
  MPI_Comm comm;
  std::FILE *stream;
  const int open_error;
  std::uint64_t size = 0;
  std::map<std::string, Section> sections;
};

namespace {

/// What is wrong with a checkpoint, if anything.
struct Defect
{
  std::string text;
  bool is_damage = false;

  /// Runs an action, unless something is wrong already.
  template <typename Action>
  void attempt(const std::string &path, const Action &action)
  {
    if (!text.empty())
      return;
    try {
      action();
    } catch (const DamagedCheckpoint &problem) {
      text = problem.what();
      is_damage = true;
    } catch (const UserError &problem) {
      text = problem.what();
    } catch (const std::exception &) {
      // Of JSON, or of a value in it.
      text = "The checkpoint " + path + " is damaged: its head is not understood.";
      is_damage = true;
    }
  }

  /// Throws on every rank what the first rank that has a defect says; collective.
  void agree(MPI_Comm comm) const
  {
    int first = text.empty() ? size_of(comm) : rank_in(comm);
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, comm);
    if (first == size_of(comm))
      return;
    const std::string sentence = broadcast(text, comm, first);
    int damage = is_damage ? 1 : 0;
    MPI_Bcast(&damage, 1, MPI_INT, first, comm);
    if (damage != 0)
      throw DamagedCheckpoint(sentence);
    throw UserError(sentence);
  }
};

} // namespace

Checkpoint::Checkpoint(const std::string &path, MPI_Comm comm)
    : path(path), comm(comm), file(std::make_unique<File>(path, comm))
{
  Defect defect;
  defect.attempt(path, [&] { file->require_open(); });
  defect.agree(comm);

  Checksum share;
  defect.attempt(path, [&] { share = file->checksum_of_share(); });
  defect.agree(comm);
  std::vector<Checksum> whole = {share};
  join_pieces(whole, comm);

  std::string text;
  if (is_first_rank(comm))
    defect.attempt(path, [&] {
      std::uint64_t sum;
      file->read_at(file->size - sizeof sum, &sum, sizeof sum);
      text = file->head(sum == whole[0].value);
    });
  defect.agree(comm);
  text = broadcast(text, comm);
  defect.attempt(path, [&] {
    head = nlohmann::ordered_json::parse(text);
    const std::uint64_t begin =
        format_name.size() + format_version.size() + 1 + sizeof(std::uint64_t) + text.size();
    file->find_sections(head.at("sections"), begin);
  });
  defect.agree(comm);
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
  const auto found = file->sections.find(name);
  if (found == file->sections.end())
    throw UserError("The checkpoint " + path + " has no section '" + name + "'.");
  const File::Section &section = found->second;
  const std::uint64_t first = first_of(section.n_rows, rank, n_ranks);

  std::vector<std::uint32_t> lengths(first_of(section.n_rows, rank + 1, n_ranks) - first);
  on_every_rank(comm, [&] {
    file->read_at(section.begin + first * sizeof(std::uint32_t), lengths.data(),
                  lengths.size() * sizeof(std::uint32_t));
  });
  Rows mine;
  // Not std::partial_sum, which adds in the type of the lengths.
  mine.starts.assign(lengths.size() + 1, 0);
  for (std::size_t k = 0; k < lengths.size(); ++k)
    mine.starts[k + 1] = mine.starts[k] + lengths[k];
  const std::uint64_t n_values = mine.starts.back();
  std::uint64_t before = 0, all = 0;
  MPI_Exscan(&n_values, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
  MPI_Allreduce(&n_values, &all, 1, MPI_UINT64_T, MPI_SUM, comm);
  on_every_rank(comm, [&] {
    if (all != section.n_values)
      file->refuse("is damaged: the rows of '" + name + "' do not fill their section.");
    mine.values.resize(n_values);
    const std::uint64_t begin = section.begin + section.n_rows * sizeof(std::uint32_t);
    file->read_at(begin + (rank == 0 ? 0 : before) * sizeof(double), mine.values.data(),
                  n_values * sizeof(double));
  });
  return mine;
}

} // namespace eunoe
