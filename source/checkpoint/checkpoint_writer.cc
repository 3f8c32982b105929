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
  PartedFile(const std::string &path, MPI_Comm comm) : comm(comm), file(path, comm) {}

  /// Writes this rank's piece of the next part; collective.
  void write(const void *piece, const std::uint64_t n)
  {
    const Share share(n, comm);
    file.write(size + share.before, piece, n);
    Checksum checksum;
    checksum.add(piece, n);
    pieces.insert(pieces.end(), {checksum.value, n});
    size += share.all;
  }

  /// Adds the checksum and waits for the disk; collective.
  /// @return size of the file (bytes)
  std::uint64_t complete()
  {
    const int n_ranks = size_of(comm), n = static_cast<int>(pieces.size());
    std::vector<std::uint64_t> all(rank_in(comm) == 0 ? pieces.size() * n_ranks : 0);
    MPI_Gather(pieces.data(), n, MPI_UINT64_T, all.data(), n, MPI_UINT64_T, 0, comm);
    if (rank_in(comm) == 0) {
      Checksum whole;
      for (int part = 0; part < n; part += 2)
        for (int r = 0; r < n_ranks; ++r) {
          const std::uint64_t *const piece = &all[static_cast<std::size_t>(r) * n + part];
          whole.append({piece[0], piece[1]});
        }
      file.write(size, &whole.value, sizeof whole.value);
    }
    file.complete();
    return size + sizeof(std::uint64_t);
  }

private:
  MPI_Comm comm;
  SharedFile file;
  std::uint64_t size = 0;
  std::vector<std::uint64_t> pieces; ///< checksum and size of each of this rank's
};

} // namespace

void CheckpointWriter::add_rows(const std::string &name, const std::vector<std::uint32_t> &keys,
                                const Rows &rows)
{
  sections.push_back({name, sort_rows(keys, rows, comm).rows});
}

std::uint64_t CheckpointWriter::write(const std::string &path)
{
  for (const auto &[name, rows] : sections)
    head["sections"].push_back({{"name", name},
                                {"rows", Share(rows.size(), comm).all},
                                {"values", Share(rows.values.size(), comm).all}});
  PartedFile file(path, comm);
  std::string title;
  if (rank_in(comm) == 0) {
    const std::string text = head.dump();
    const std::uint64_t length = text.size();
    title = format_name + format_version + "\n";
    title.append(reinterpret_cast<const char *>(&length), sizeof length);
    title += text;
  }
  file.write(title.data(), title.size());
  for (const auto &[name, rows] : sections) {
    std::vector<std::uint32_t> lengths(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
      lengths[k] = static_cast<std::uint32_t>(rows.length(k));
    file.write(lengths.data(), lengths.size() * sizeof(std::uint32_t));
    file.write(rows.values.data(), rows.values.size() * sizeof(double));
  }
  try {
    return file.complete();
  } catch (const UserError &error) {
    throw UserError("The checkpoint " + std::string(error.what()) +
                    " Earlier checkpoints are as they were.");
  }
}

} // namespace eunoe
