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
/// disk. Only then the oldest goes.
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

  /// Whether there is any; to be asked on one rank.
  bool has_any() const { return !present().empty(); }

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
  /// What the index names; nothing if it is not in order.
  std::vector<std::string> listed() const;
  /// All that are there, by their steps, the last first.
  std::vector<std::string> present() const;
  void remove_unfinished() const;
  /// All, in the order in which they are tried; collective.
  std::vector<std::string> find(std::string &defect);
  std::string index() const { return folder + "/" + name + ".latest"; }

  const std::string folder, name;
  const unsigned int keep;
  MPI_Comm comm;
  std::vector<std::string> files;   ///< names, the newest first
  std::vector<std::string> earlier; ///< the one that was opened and those after it
};

} // namespace eunoe

#endif
