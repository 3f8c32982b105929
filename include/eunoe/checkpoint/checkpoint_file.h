#ifndef eunoe_checkpoint_checkpoint_file_h
#define eunoe_checkpoint_checkpoint_file_h

#include <eunoe/core/problems.h>
#include <eunoe/core/rows.h>

#include <nlohmann/json.hpp>

#include <memory>
#include <string>

namespace eunoe {

// A checkpoint is one file: a line that names the format, the length of the head, the head (JSON:
// all that is small), then sections of rows of doubles. Behind these contents stand their length, a
// checksum (CRC-32) of each chunk of them of 4 MiB, and one of everything. Numbers are
// little-endian; checksums of chunks have 4 bytes, that of everything and lengths 8. Rows are
// ordered by a key, so the file is the same on any number of ranks. Every rank writes and reads its
// own part of it.

/// Collects the state of a run and writes it at once.
class CheckpointWriter
{
public:
  explicit CheckpointWriter(MPI_Comm comm) : comm(comm) {}

  MPI_Comm communicator() const { return comm; }

  /// What is small and known to every rank; the first rank's counts.
  nlohmann::ordered_json head;

  /// Adds a section; collective.
  /// @param keys one per row, different from each other on all ranks
  void add_rows(const std::string &name, const std::vector<std::uint32_t> &keys, Rows &&rows);

  /// Writes the file beside an old one of this name and renames it when it is complete and on the
  /// disk; collective. Throws a UserError on every rank if that fails, and leaves the old file.
  /// @return size of the file (bytes)
  std::uint64_t write(const std::string &path);

private:
  struct Section
  {
    std::string name;
    RowViews rows; ///< this rank's part of the rows in the order of the keys
  };

  MPI_Comm comm;
  std::vector<Section> sections;
};

/// Thrown for a checkpoint that is missing, cut short or damaged, so that an older one has to do.
class DamagedCheckpoint : public UserError
{
  using UserError::UserError;
};

/// A checkpoint that has been read and found whole.
class Checkpoint
{
public:
  /// Reads the whole file once, each rank the head and its share of the rows, and verifies it;
  /// collective. Throws a DamagedCheckpoint on every rank, or a UserError for a file that may be
  /// whole but cannot be read, as one of another version or one that the system does not give a
  /// node.
  Checkpoint(const std::string &path, MPI_Comm comm);
  ~Checkpoint();

  const std::string path;
  nlohmann::ordered_json head;

  /// This rank's share of a section, in the order of the keys.
  const Rows &rows(const std::string &name) const;

  /// Throws a UserError on every rank unless @p ok on all; collective.
  /// @param what is wrong with the checkpoint otherwise, after "is damaged: "
  void require(bool ok, const std::string &what) const;

  /// How a checkpoint is refused that is whole and yet not what it should be.
  UserError damaged(const std::string &what) const;

private:
  struct File;
  MPI_Comm comm;
  std::unique_ptr<File> file;
};

} // namespace eunoe

#endif
