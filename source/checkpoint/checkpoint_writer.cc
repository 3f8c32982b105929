#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/core/files.h>
#include <eunoe/core/shared_file.h>

#include "format.h"

namespace eunoe {

using namespace checkpoint_format;

namespace {

/// The number before this rank's share of something, and the whole number; collective.
struct Share
{
  std::uint64_t before = 0, all = 0;

  Share(const std::uint64_t mine, MPI_Comm comm)
  {
    MPI_Exscan(&mine, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
    MPI_Allreduce(&mine, &all, 1, MPI_UINT64_T, MPI_SUM, comm);
    if (rank_in(comm) == 0)
      before = 0;
  }
};

/// A file of parts, of which each rank has a piece, in the order of the ranks.
class PartedFile
{
public:
  /// @param n_bytes of all parts together
  PartedFile(const std::string &path, const std::uint64_t n_bytes, MPI_Comm comm)
      : comm(comm), file(path, comm), checksums(n_bytes, chunk_length)
  {
  }

  /// Writes this rank's piece of the next part; collective.
  void write(const void *piece, const std::uint64_t n)
  {
    const Share share(n, comm);
    write_at(size + share.before, piece, n);
    size += share.all;
  }

  /// Writes the values of this rank's rows as the next part; collective.
  void write(const RowViews &rows)
  {
    constexpr std::size_t at_once = 1 << 17;
    const Share share(rows.n_values() * sizeof(double), comm);
    std::uint64_t begin = size + share.before;
    std::vector<double> buffer;
    const auto flush = [&] {
      write_at(begin, buffer.data(), buffer.size() * sizeof(double));
      begin += buffer.size() * sizeof(double);
      buffer.clear();
    };
    for (std::size_t k = 0; k < rows.size(); ++k) {
      buffer.insert(buffer.end(), rows[k], rows.end(k));
      if (buffer.size() >= at_once)
        flush();
    }
    flush();
    size += share.all;
  }

  /// Adds the checksums of the chunks, and that of all, and waits for the disk; collective.
  /// @return size of the file (bytes)
  std::uint64_t complete()
  {
    checksums.join(comm);
    const std::uint64_t n_of_chunks = checksums.values.size() * sizeof(std::uint32_t);
    const std::uint64_t begin = size + sizeof checksums.n_bytes, end = begin + n_of_chunks;
    if (rank_in(comm) == 0) {
      const std::uint64_t of_all = checksums.of_all();
      file.write(size, &checksums.n_bytes, sizeof checksums.n_bytes);
      file.write(begin, checksums.values.data(), n_of_chunks);
      file.write(end, &of_all, sizeof of_all);
    }
    file.complete();
    return end + sizeof(std::uint64_t);
  }

private:
  void write_at(const std::uint64_t begin, const void *data, const std::uint64_t n)
  {
    file.write(begin, data, n);
    checksums.add(begin, data, n);
  }

  MPI_Comm comm;
  SharedFile file;
  std::uint64_t size = 0;
  ChunkChecksums checksums; ///< what this rank has added
};

} // namespace

void CheckpointWriter::add_rows(const std::string &name, const std::vector<std::uint32_t> &keys,
                                Rows &&rows)
{
  sections.push_back({name, sort_rows(keys, std::move(rows), comm).rows});
}

std::uint64_t CheckpointWriter::write(const std::string &path)
{
  std::uint64_t n_bytes = 0;
  for (const auto &[name, rows] : sections) {
    const std::uint64_t n_rows = Share(rows.size(), comm).all;
    const std::uint64_t n_values = Share(rows.n_values(), comm).all;
    head["sections"].push_back({{"name", name}, {"rows", n_rows}, {"values", n_values}});
    n_bytes += n_rows * sizeof(std::uint32_t) + n_values * sizeof(double);
  }
  std::string title;
  if (rank_in(comm) == 0) {
    const std::string text = head.dump();
    const std::uint64_t length = text.size();
    title = format_name + format_version + "\n";
    title.append(reinterpret_cast<const char *>(&length), sizeof length);
    title += text;
  }
  n_bytes += Share(title.size(), comm).all;
  PartedFile file(path, n_bytes, comm);
  file.write(title.data(), title.size());
  for (const auto &[name, rows] : sections) {
    std::vector<std::uint32_t> lengths(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
      lengths[k] = static_cast<std::uint32_t>(rows.length(k));
    file.write(lengths.data(), lengths.size() * sizeof(std::uint32_t));
    file.write(rows);
  }
  try {
    return file.complete();
  } catch (const UserError &error) {
    throw UserError("The checkpoint " + std::string(error.what()) +
                    " Earlier checkpoints are as they were.");
  }
}

} // namespace eunoe
