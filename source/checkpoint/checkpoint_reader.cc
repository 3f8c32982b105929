#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/head_values.h>
#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/machine.h>

#include "format.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>

namespace eunoe {

using namespace checkpoint_format;

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
    } catch (const std::bad_alloc &) {
      // It may be whole, and then no older one may take its place.
      text = "The checkpoint " + path +
             " needs more memory than there is. Start the run on more nodes.";
    } catch (const std::exception &) {
      // Of JSON, or of a value in it.
      text = "The checkpoint " + path + " is damaged: its head is not understood.";
      is_damage = true;
    }
  }

  /// The first rank that has a defect, the number of ranks if none has; collective.
  int first_rank(MPI_Comm comm) const
  {
    int first = text.empty() ? size_of(comm) : rank_in(comm);
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, comm);
    return first;
  }

  bool is_anywhere(MPI_Comm comm) const { return first_rank(comm) < size_of(comm); }

  /// Throws on every rank what the first rank that has a defect says; collective.
  void agree(MPI_Comm comm) const
  {
    const int first = first_rank(comm);
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

/// The file, and what this rank has read of it.
struct Checkpoint::File
{
  struct Section
  {
    std::string name;
    std::uint64_t begin, n_rows, n_values; ///< begin: place of the lengths (bytes)
    Rows share;                            ///< of this rank
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

  /// Refuses a file that the system does not give this node. It may be whole, so no older one may
  /// take its place, for which it would be removed.
  [[noreturn]] void refuse_unread(const int error) const
  {
    const bool is_forbidden = error == EACCES || error == EPERM;
    throw UserError(
        "The checkpoint " + path + " cannot be read on " + host_name() + ": " +
        std::strerror(error) +
        (is_forbidden
             ? ". Mend its permissions."
             : ". Look after the file system of that node, or move the file away to go on from an "
               "older one."));
  }

  void read(void *data, std::uint64_t n)
  {
    if (n == 0 || std::fread(data, 1, n, stream) == n)
      return;
    const int error = errno;
    if (std::feof(stream) != 0)
      refuse("cannot be read: it ends too early.");
    refuse_unread(error);
  }

  void seek(std::uint64_t begin)
  {
    // It may read, too.
    if (std::fseek(stream, static_cast<long>(begin), SEEK_SET) != 0)
      refuse_unread(errno);
  }

  /// Reads bytes and adds them to the checksums while they are in the cache.
  void read_at(std::uint64_t begin, void *const data, const std::uint64_t n,
               ChunkChecksums &checksums)
  {
    seek(begin);
    char *to = static_cast<char *>(data);
    for (std::uint64_t left = n; left > 0;) {
      const std::uint64_t here = std::min(left, buffer_size);
      read(to, here);
      checksums.add(begin, to, here);
      begin += here;
      to += here;
      left -= here;
    }
  }

  void require_open()
  {
    if (stream == nullptr) {
      if (open_error == ENOENT && is_first_rank(comm))
        refuse("cannot be read: " + std::string(std::strerror(open_error)) + ".");
      if (open_error == ENOENT)
        throw UserError("The checkpoint " + path +
                        " is not seen by every node. Put it into a folder that all share.");
      refuse_unread(open_error);
    }
    std::error_code failure;
    size = std::filesystem::file_size(path, failure);
    if (failure)
      refuse_unread(failure.value());
    if (size < format_name.size() + 2 + 2 * sizeof(std::uint64_t))
      refuse("is cut short: it has " + std::to_string(size) + " bytes.");
  }

  std::string read_version()
  {
    std::string title(format_name.size(), ' ');
    seek(0);
    read(title.data(), title.size());
    if (title != format_name)
      refuse("is no checkpoint of Eunoe.");
    std::string text;
    for (int c = std::fgetc(stream); c != '\n' && text.size() < 20; c = std::fgetc(stream))
      text += c >= ' ' && c <= '~' ? static_cast<char>(c) : '?';
    return text;
  }

  bool has_chunks() const { return version == format_version; }
  bool is_readable() const { return has_chunks() || version == version_without_chunks; }

  /// Tells the contents from the checksums behind them.
  void set_version(const std::string &text)
  {
    version = text;
    n_bytes = size - sizeof(std::uint64_t);
    if (has_chunks()) {
      constexpr std::uint64_t with_checksum = chunk_length + sizeof(std::uint32_t);
      n_bytes -= sizeof n_bytes;
      n_bytes -= (n_bytes + with_checksum - 1) / with_checksum * sizeof(std::uint32_t);
    }
  }

  /// Those of no bytes yet. A file of another version is one chunk.
  ChunkChecksums no_checksums() const
  {
    return ChunkChecksums(n_bytes, has_chunks() ? chunk_length : n_bytes);
  }

  /// Where the text of the head begins, behind its length.
  std::uint64_t begin_of_head() const
  {
    return format_name.size() + version.size() + 1 + sizeof(std::uint64_t);
  }

  std::string read_head(ChunkChecksums &checksums)
  {
    // Longer than any, and what one rank can hold if the length is damaged.
    constexpr std::uint64_t longest = std::uint64_t(1) << 30;
    const std::uint64_t begin = begin_of_head();
    std::uint64_t length = n_bytes;
    if (begin <= n_bytes) {
      std::string title(begin, ' ');
      read_at(0, title.data(), begin, checksums);
      std::memcpy(&length, title.data() + begin - sizeof length, sizeof length);
    }
    if (begin > n_bytes || length > n_bytes - begin || length > longest)
      refuse("is damaged: its head does not fit into it.");
    std::string text(length, ' ');
    read_at(begin, text.data(), length, checksums);
    return text;
  }

  /// Notes the places of the sections, which begin at @p begin and must fill the file.
  void find_sections(const nlohmann::ordered_json &list, std::uint64_t begin)
  {
    for (const auto &section : list) {
      const std::uint64_t n_rows = count_in(section.at("rows"));
      const std::uint64_t n_values = count_in(section.at("values"));
      const std::uint64_t left = n_bytes - begin;
      if (n_rows > left / sizeof(std::uint32_t) ||
          n_values > (left - n_rows * sizeof(std::uint32_t)) / sizeof(double))
        refuse("is damaged: its sections do not fit into it.");
      sections.push_back({section.at("name").get<std::string>(), begin, n_rows, n_values, Rows()});
      begin += n_rows * sizeof(std::uint32_t) + n_values * sizeof(double);
    }
    if (begin != n_bytes)
      refuse("is damaged: its sections do not fill it.");
  }

  /// Reads this rank's rows of a section, of about as many as the other ranks have; collective.
  void read_share(Section &section, ChunkChecksums &checksums, Defect &defect)
  {
    const int n_ranks = size_of(comm), rank = rank_in(comm);
    const std::uint64_t first = first_of(section.n_rows, rank, n_ranks);
    Rows &mine = section.share;
    std::uint64_t n_values = 0;
    defect.attempt(path, [&] {
      std::vector<std::uint32_t> lengths(first_of(section.n_rows, rank + 1, n_ranks) - first);
      read_at(section.begin + first * sizeof(std::uint32_t), lengths.data(),
              lengths.size() * sizeof(std::uint32_t), checksums);
      // Not std::partial_sum, which adds in the type of the lengths.
      mine.starts.assign(lengths.size() + 1, 0);
      for (std::size_t k = 0; k < lengths.size(); ++k)
        mine.starts[k + 1] = mine.starts[k] + lengths[k];
      n_values = mine.starts.back();
    });
    // Where one has no lengths, the others would blame the file for the sum that does not fit.
    if (defect.is_anywhere(comm))
      return;
    std::uint64_t before = 0, all = 0;
    MPI_Exscan(&n_values, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
    MPI_Allreduce(&n_values, &all, 1, MPI_UINT64_T, MPI_SUM, comm);
    if (rank == 0)
      before = 0;
    defect.attempt(path, [&] {
      // Sums of damaged lengths may run over.
      if (all != section.n_values || n_values > all || before > all - n_values)
        refuse("is damaged: its rows do not fill their sections.");
      mine.values.resize(n_values);
      read_at(section.begin + section.n_rows * sizeof(std::uint32_t) + before * sizeof(double),
              mine.values.data(), n_values * sizeof(double), checksums);
    });
  }

  /// Reads the head and this rank's rows of all sections, so that all ranks together read each byte
  /// once. What is read is not known to be right yet and says no more than where to read;
  /// collective.
  void read_contents(nlohmann::ordered_json &head, ChunkChecksums &checksums, Defect &defect)
  {
    std::string text;
    if (is_first_rank(comm))
      defect.attempt(path, [&] {
        text = read_head(checksums);
        head = nlohmann::ordered_json::parse(text);
      });
    if (defect.is_anywhere(comm))
      return;
    text = broadcast(text, comm);
    defect.attempt(path, [&] {
      if (!is_first_rank(comm))
        head = nlohmann::ordered_json::parse(text);
      find_sections(head.at("sections"), begin_of_head() + text.size());
    });
    if (defect.is_anywhere(comm))
      return;
    for (Section &section : sections)
      read_share(section, checksums, defect);
  }

  /// Reads this rank's part of all bytes, whatever they are, for the checksums alone.
  void read_any_bytes(ChunkChecksums &checksums)
  {
    const int n_ranks = size_of(comm), rank = rank_in(comm);
    const std::uint64_t end = first_of(n_bytes, rank + 1, n_ranks);
    std::vector<char> part(buffer_size);
    for (std::uint64_t begin = first_of(n_bytes, rank, n_ranks); begin < end;) {
      const std::uint64_t here = std::min(end - begin, buffer_size);
      read_at(begin, part.data(), here, checksums);
      begin += here;
    }
  }

  /// Refuses a file that is not as it was written, and one of a version that cannot be read; on the
  /// first rank.
  /// @param found checksums of what all ranks have read
  void verify(const ChunkChecksums &found)
  {
    ChunkChecksums written = found;
    std::uint64_t of_all = 0;
    seek(n_bytes);
    if (has_chunks()) {
      const std::uint64_t n = size - n_bytes - 2 * sizeof(std::uint64_t);
      read(&written.n_bytes, sizeof written.n_bytes);
      written.values.resize(n / sizeof(std::uint32_t));
      read(written.values.data(), n);
    }
    read(&of_all, sizeof of_all);
    // Whether the checksums of the chunks are right.
    const bool is_known = has_chunks() && written.n_bytes == n_bytes &&
                          written.values.size() == found.values.size() &&
                          written.of_all() == of_all;
    const bool is_whole = has_chunks() ? is_known && written.values == found.values
                                       : found.of_contents().value == of_all;
    if (!is_readable()) {
      const std::string text = "The checkpoint " + path + " has version " + version +
                               " of the format, and this program reads versions " +
                               version_without_chunks + " and " + format_version;
      if (is_whole)
        throw UserError(text + ". Use the program that wrote it, or start anew.");
      throw DamagedCheckpoint(text + ", or it is damaged.");
    }
    if (is_whole)
      return;
    if (!has_chunks())
      refuse("is cut short or damaged: its checksum does not fit.");
    if (is_known)
      refuse_chunks(found, written);
    refuse("is cut short, or damaged at its end: the checksums from byte " +
           std::to_string(n_bytes) + " on do not fit.");
  }

  /// Names the chunks that have other checksums than they had.
  [[noreturn]] void refuse_chunks(const ChunkChecksums &found, const ChunkChecksums &written) const
  {
    const std::size_t n = found.values.size();
    const auto differs = [&](const std::size_t chunk) {
      return found.values[chunk] != written.values[chunk];
    };
    std::size_t first = 0, last = n - 1;
    while (first < last && !differs(first))
      ++first;
    while (last > first && !differs(last))
      --last;
    std::size_t end = first + 1;
    while (end < n && differs(end))
      ++end;
    std::string text = "is damaged: its bytes " + std::to_string(found.begin_of(first)) + " to " +
                       std::to_string(found.end_of(end - 1) - 1) + " are not as they were written";
    if (end <= last)
      text += ", nor are further ones up to byte " + std::to_string(found.end_of(last) - 1);
    refuse(text + ".");
  }

  static constexpr std::uint64_t buffer_size = 1u << 20;
  const std::string path;
  MPI_Comm comm;
  std::FILE *stream;
  const int open_error;
  std::uint64_t size = 0;
  std::string version;
  std::uint64_t n_bytes = 0; ///< before the checksums
  std::vector<Section> sections;
};

Checkpoint::Checkpoint(const std::string &path, MPI_Comm comm)
    : path(path), comm(comm), file(std::make_unique<File>(path, comm))
{
  Defect defect;
  defect.attempt(path, [&] { file->require_open(); });
  defect.agree(comm);
  // Another node may not know the newest size yet.
  MPI_Bcast(&file->size, 1, MPI_UINT64_T, 0, comm);

  std::string version;
  if (is_first_rank(comm))
    defect.attempt(path, [&] { version = file->read_version(); });
  defect.agree(comm);
  file->set_version(broadcast(version, comm));

  ChunkChecksums found = file->no_checksums();
  Defect of_contents;
  if (file->is_readable())
    file->read_contents(head, found, of_contents);
  // If it makes no sense, the checksums of all its bytes say whether it is damaged, and where.
  if (!file->is_readable() || of_contents.is_anywhere(comm)) {
    found = file->no_checksums();
    defect.attempt(path, [&] { file->read_any_bytes(found); });
    defect.agree(comm);
  }
  found.join(comm);
  if (is_first_rank(comm))
    defect.attempt(path, [&] { file->verify(found); });
  defect.agree(comm);
  of_contents.agree(comm);
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

const Rows &Checkpoint::rows(const std::string &name) const
{
  for (const File::Section &section : file->sections)
    if (section.name == name)
      return section.share;
  throw UserError("The checkpoint " + path + " has no section '" + name + "'.");
}

} // namespace eunoe
