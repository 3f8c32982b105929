#include <eunoe/checkpoint/checkpoint_file.h>

#include "format.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <numeric>
#include <unistd.h>

namespace eunoe {

using namespace checkpoint_format;

namespace {

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
  Section section{name, all.size(), 0, fetch_rows(rows, mine, comm).copy()};
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

} // namespace eunoe
