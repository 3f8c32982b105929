#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/messages.h>
#include <eunoe/core/new_file.h>

#include "format.h"

#include <numeric>

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
  explicit Sink(const std::string &path) : file(path) {}

  void write(const void *data, std::uint64_t n)
  {
    file.write(data, n);
    checksum.process_bytes(data, n);
    size += n;
  }

  /// Completes the file and waits for the disk.
  void complete()
  {
    const std::uint64_t sum = checksum.checksum();
    write(&sum, sizeof sum);
    file.complete(true);
  }

  std::uint64_t size = 0;

private:
  NewFile file;
  Checksum checksum;
};

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

void CheckpointWriter::send_sections() const
{
  for (const Section &section : sections) {
    const std::vector<std::uint32_t> lengths = lengths_of(section.part);
    const std::uint64_t n = section.part.values.size();
    MPI_Send(&n, 1, MPI_UINT64_T, 0, tag_lengths, comm);
    send(lengths.data(), lengths.size() * sizeof(std::uint32_t), 0, tag_lengths, comm);
    send(section.part.values.data(), n * sizeof(double), 0, tag_values, comm);
  }
}

template <typename Sink>
void CheckpointWriter::write_section(const Section &section, Sink &sink) const
{
  const int n_ranks = size_of(comm);
  std::vector<std::uint32_t> lengths = lengths_of(section.part);
  std::vector<std::uint64_t> n_values(n_ranks, section.part.values.size());
  sink.write(lengths.data(), lengths.size() * sizeof(std::uint32_t));
  for (int r = 1; r < n_ranks; ++r) {
    MPI_Recv(&n_values[r], 1, MPI_UINT64_T, r, tag_lengths, comm, MPI_STATUS_IGNORE);
    lengths.resize(first_of(section.n_rows, r + 1, n_ranks) - first_of(section.n_rows, r, n_ranks));
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

std::uint64_t CheckpointWriter::write(const std::string &path)
{
  for (const Section &section : sections)
    head["sections"].push_back(
        {{"name", section.name}, {"rows", section.n_rows}, {"values", section.n_values}});
  // The first rank writes for all, section by section; the others send it their parts in turn.
  if (!is_first_rank(comm))
    send_sections();
  std::uint64_t size = 0;
  on_first_rank(comm, [&] {
    Sink sink(path);
    const std::string text = head.dump();
    const std::string title = format_name + format_version + "\n";
    const std::uint64_t length = text.size();
    sink.write(title.data(), title.size());
    sink.write(&length, sizeof length);
    sink.write(text.data(), length);
    for (const Section &section : sections)
      write_section(section, sink);
    try {
      sink.complete();
    } catch (const UserError &error) {
      throw UserError("The checkpoint " + std::string(error.what()) +
                      " Earlier checkpoints are as they were.");
    }
    size = sink.size;
  });
  return size;
}

} // namespace eunoe
