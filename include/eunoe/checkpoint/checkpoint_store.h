#ifndef eunoe_checkpoint_checkpoint_store_h
#define eunoe_checkpoint_checkpoint_store_h

#include <memory>
#include <mpi.h>
#include <string>
#include <vector>

namespace eunoe {

class Checkpoint;
class CheckpointWriter;

/// The checkpoints of a run in its output folder: "<name>_<step>.checkpoint", and "<name>.latest"
/// with their names, the newest first, which is renewed when a checkpoint is complete and on the
/// disk. Only then the oldest goes. A run that begins anew where others have left theirs marks
/// these in the index: they stay until its own first one is complete, but nothing goes on from
/// them.
class CheckpointStore
{
public:
  /// @param keep number of checkpoints that stay
  CheckpointStore(const std::string &folder, const std::string &name, unsigned int keep,
                  MPI_Comm comm)
      : folder(folder), name(name), keep(keep), comm(comm)
  {
  }

  /// Opens the newest checkpoint that is whole, null if there never was one; collective. Those that
  /// the index names come first, newer ones before older ones, then all others. Throws a UserError
  /// on every rank if none is whole, or if the newest may be whole and cannot be read.
  /// @param defects gets what is wrong with newer ones, and what was taken instead
  std::unique_ptr<Checkpoint> open_newest(std::vector<std::string> &defects);

  /// Whether another one is the newest than when they were looked for; collective.
  bool has_gone_on() const;

  /// Path of the file that names them.
  std::string index() const { return folder + "/" + name + ".latest"; }

  /// Whether there is any from which a run can go on; to be asked on one rank.
  bool has_any() const { return !candidates().empty(); }

  /// Whether a run that began anew has not come to a checkpoint yet, while those of an earlier run
  /// are still there; collective.
  bool was_begun_anew() const;

  /// Marks those that are there as of an earlier run, and forgets those that are gone; collective.
  void begin_anew();

  /// Gives the one that was opened a second name, "<name>_phase_<step>.checkpoint", by which it
  /// stays; collective.
  void keep_opened();

  /// Goes on behind the one that was opened; without it those that are there are dropped as soon as
  /// the first new one is complete.
  void go_on();

  /// Writes a checkpoint and drops the oldest; collective. Throws like CheckpointWriter::write.
  /// @return its path
  std::string write(CheckpointWriter &writer, unsigned long long step);

private:
  bool is_ours(const std::string &file) const;
  struct Index
  {
    std::vector<std::string> names; ///< nothing if it is not in order
    bool begun_anew = false;        ///< the names are of an earlier run
  };
  Index read_index() const;
  /// All that are there, by their steps, the last first.
  std::vector<std::string> present() const;
  /// Those from which a run can go on, in the order in which they are tried.
  std::vector<std::string> candidates() const;
  void remove_unfinished() const;
  /// The same on every rank, and what is wrong with the index; collective.
  std::vector<std::string> find(std::string &defect);

  const std::string folder, name;
  const unsigned int keep;
  MPI_Comm comm;
  std::vector<std::string> files;   ///< names, the newest first
  std::vector<std::string> earlier; ///< the one that was opened and those after it
  std::string newest;               ///< name of the first one that was tried; empty: none
};

} // namespace eunoe

#endif
