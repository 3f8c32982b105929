#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/core/problems.h>

#include <boost/crc.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <numeric>
#include <unistd.h>

namespace eunoe {

namespace {

const std::string format_name = "Eunoe checkpoint ", format_version = "1";

/// CRC-64 of ECMA-182.
using Checksum = boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0, 0, false, false>;

constexpr int tag_lengths = 321, tag_values = 322;

int rank_in(MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

int size_of(MPI_Comm comm)
{
  int size;
  MPI_Comm_size(comm, &size);
  return size;
}

/// First of the items that belong to a rank.
std::uint64_t first_of(std::uint64_t n, int rank, int n_ranks)
{
  return n * static_cast<std::uint64_t>(rank) / static_cast<std::uint64_t>(n_ranks);
}

/// Messages of any size in parts that MPI can count.
void send(const void *data, std::uint64_t n_bytes, int to, int tag, MPI_Comm comm)
{
  constexpr std::uint64_t part = 1u << 30;
  for (std::uint64_t begin = 0; begin < n_bytes; begin += part)
    MPI_Send(static_cast<const char *>(data) + begin,
             static_cast<int>(std::min(part, n_bytes - begin)), MPI_BYTE, to, tag, comm);
}

void receive(void *data, std::uint64_t n_bytes, int from, int tag, MPI_Comm comm)
{
  constexpr std::uint64_t part = 1u << 30;
  for (std::uint64_t begin = 0; begin < n_bytes; begin += part)
    MPI_Recv(static_cast<char *>(data) + begin, static_cast<int>(std::min(part, n_bytes - begin)),
             MPI_BYTE, from, tag, comm, MPI_STATUS_IGNORE);
}

/// Gives an error of the first rank to all, who throw it.
void agree(std::string error, MPI_Comm comm)
{
  int size = static_cast<int>(error.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  error.resize(size);
  MPI_Bcast(error.data(), size, MPI_CHAR, 0, comm);
  if (!error.empty())
    throw UserError(error);
}

std::vector<std::uint32_t> lengths_of(const Rows &rows)
{
  std::vector<std::uint32_t> lengths(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
    lengths[k] = static_cast<std::uint32_t>(rows.length(k));
  return lengths;
}

/// A file that is being written, with the checksum of what is in it.
class Sink
{
public:
  explicit Sink(const std::string &path) : file(std::fopen(path.c_str(), "wb")) { note(file); }
  ~Sink()
  {
    if (file != nullptr)
      std::fclose(file);
  }

  void write(const void *data, std::uint64_t n)
  {
    if (n == 0 || !error.empty())
      return;
    note(std::fwrite(data, 1, n, file) == n);
    checksum.process_bytes(data, n);
    size += n;
  }

  /// Completes the file and waits for the disk.
  void close()
  {
    const std::uint64_t sum = checksum.checksum();
    write(&sum, sizeof sum);
    if (file == nullptr)
      return;
    note(std::fflush(file) == 0 && fsync(fileno(file)) == 0);
    note(std::fclose(file) == 0);
    file = nullptr;
  }

  std::string error;
  std::uint64_t size = 0;

private:
  void note(bool ok)
  {
    if (!ok && error.empty())
      error = std::strerror(errno);
  }

  std::FILE *file;
  Checksum checksum;
};

/// Makes the new name of a file in a folder last, too.
void sync_folder(const std::string &path)
{
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int handle = open(folder.empty() ? "." : folder.c_str(), O_RDONLY);
  if (handle >= 0) {
    fsync(handle);
    close(handle);
  }
}

} // namespace

void CheckpointWriter::add_rows(const std::string &name, const std::vector<std::uint32_t> &keys,
                                const Rows &rows)
{
  const int n_ranks = size_of(comm), rank = rank_in(comm);
  const int n = static_cast<int>(keys.size());
  std::vector<int> counts(n_ranks), starts(n_ranks, 0);
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  std::partial_sum(counts.begin(), counts.end() - 1, starts.begin() + 1);
  std::vector<std::uint32_t> all(static_cast<std::size_t>(starts.back()) + counts.back());
  MPI_Allgatherv(keys.data(), n, MPI_UINT32_T, all.data(), counts.data(), starts.data(),
                 MPI_UINT32_T, comm);

  struct Place
  {
    std::uint32_t key;
    Origin origin;
  };
  std::vector<Place> places;
  places.reserve(all.size());
  for (int r = 0; r < n_ranks; ++r)
    for (int k = 0; k < counts[r]; ++k)
      places.push_back({all[starts[r] + k], {r, k}});
  std::sort(places.begin(), places.end(),
            [](const Place &a, const Place &b) { return a.key < b.key; });

  std::vector<Origin> mine;
  for (std::uint64_t k = first_of(all.size(), rank, n_ranks);
       k < first_of(all.size(), rank + 1, n_ranks); ++k)
    mine.push_back(places[k].origin);
  Section section{name, all.size(), 0, fetch_rows(rows, mine, comm)};
  section.n_values = section.part.values.size();
  MPI_Allreduce(MPI_IN_PLACE, &section.n_values, 1, MPI_UINT64_T, MPI_SUM, comm);
  sections.push_back(std::move(section));
}

std::uint64_t CheckpointWriter::write(const std::string &path)
{
  const int n_ranks = size_of(comm), rank = rank_in(comm);
  for (const Section &section : sections)
    head["sections"].push_back(
        {{"name", section.name}, {"rows", section.n_rows}, {"values", section.n_values}});

  // The first rank writes for all, section by section; the others send it their parts in turn.
  if (rank != 0) {
    for (const Section &section : sections) {
      const std::vector<std::uint32_t> lengths = lengths_of(section.part);
      const std::uint64_t n = section.part.values.size();
      MPI_Send(&n, 1, MPI_UINT64_T, 0, tag_lengths, comm);
      send(lengths.data(), lengths.size() * sizeof(std::uint32_t), 0, tag_lengths, comm);
      send(section.part.values.data(), n * sizeof(double), 0, tag_values, comm);
    }
    agree("", comm);
    return 0;
  }

  const std::string beside = path + ".new";
  std::string error;
  std::uint64_t size = 0;
  {
    Sink sink(beside);
    const std::string text = head.dump();
    const std::string title = format_name + format_version + "\n";
    const std::uint64_t length = text.size();
    sink.write(title.data(), title.size());
    sink.write(&length, sizeof length);
    sink.write(text.data(), length);
    for (const Section &section : sections) {
      std::vector<std::uint32_t> lengths = lengths_of(section.part);
      std::vector<std::uint64_t> n_values(n_ranks, section.part.values.size());
      sink.write(lengths.data(), lengths.size() * sizeof(std::uint32_t));
      for (int r = 1; r < n_ranks; ++r) {
        MPI_Recv(&n_values[r], 1, MPI_UINT64_T, r, tag_lengths, comm, MPI_STATUS_IGNORE);
        lengths.resize(first_of(section.n_rows, r + 1, n_ranks) -
                       first_of(section.n_rows, r, n_ranks));
        receive(lengths.data(), lengths.size() * sizeof(std::uint32_t), r, tag_lengths, comm);
        sink.write(lengths.data(), lengths.size() * sizeof(std::uint32_t));
      }
      sink.write(section.part.values.data(), section.part.values.size() * sizeof(double));
      std::vector<double> values;
      for (int r = 1; r < n_ranks; ++r) {
        values.resize(n_values[r]);
        receive(values.data(), values.size() * sizeof(double), r, tag_values, comm);
        sink.write(values.data(), values.size() * sizeof(double));
      }
    }
    sink.close();
    error = sink.error;
    size = sink.size;
  }
  std::error_code failure;
  if (error.empty()) {
    std::filesystem::rename(beside, path, failure);
    if (failure)
      error = failure.message();
    else
      sync_folder(path);
  }
  if (!error.empty()) {
    std::filesystem::remove(beside, failure);
    error = "The checkpoint " + path + " cannot be written: " + error +
            ". Check the folder's permissions and the free space; earlier checkpoints are as they "
            "were.";
  }
  agree(error, comm);
  return size;
}

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
    if (length > size)
      refuse("is damaged: its head does not fit into it." + mend);
    std::string text(length, ' ');
    std::fseek(stream, static_cast<long>(title.size() + version.size() + 1 + sizeof length),
               SEEK_SET);
    read(text.data(), length);
    return text;
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
      auto begin = static_cast<std::uint64_t>(std::ftell(file->stream));
      head = nlohmann::ordered_json::parse(text);
      for (const auto &section : head["sections"]) {
        const std::uint64_t n_rows = section["rows"], n_values = section["values"];
        file->sections[section["name"]] = {begin, n_rows, n_values};
        begin += n_rows * sizeof(std::uint32_t) + n_values * sizeof(double);
      }
      if (begin + sizeof(std::uint64_t) != file->size)
        file->refuse("is damaged: its sections do not fill it.");
    } catch (const nlohmann::json::exception &) {
      error = "The checkpoint " + path + " is damaged: its head is not understood.";
    } catch (const UserError &problem) {
      error = problem.what();
    }
  agree(error, comm);
  std::uint64_t length = text.size();
  MPI_Bcast(&length, 1, MPI_UINT64_T, 0, comm);
  text.resize(length);
  MPI_Bcast(text.data(), static_cast<int>(length), MPI_CHAR, 0, comm);
  head = nlohmann::ordered_json::parse(text);
}

Checkpoint::~Checkpoint() = default;

Rows Checkpoint::rows(const std::string &name) const
{
  const int n_ranks = size_of(comm), rank = rank_in(comm);
  std::uint64_t n_rows = 0;
  for (const auto &section : head["sections"])
    if (section["name"] == name)
      n_rows = section["rows"];
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
