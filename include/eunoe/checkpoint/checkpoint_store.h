#ifndef eunoe_checkpoint_checkpoint_store_h
#define eunoe_checkpoint_checkpoint_store_h

#include <eunoe/checkpoint/checkpoint_file.h>

namespace eunoe {

/// The checkpoints of a run in its output folder: "<name>_<step>.checkpoint", and "<name>.latest"
/// with their names, the newest first, which is renewed when a checkpoint is complete.
class CheckpointStore
{
public:
  /// @param keep number of checkpoints that stay
  CheckpointStore(const std::string &folder, const std::string &name, unsigned int keep,
                  MPI_Comm comm)
      : folder(folder), name(name), keep(keep), comm(comm)
  {
  }

  /// Path of the newest checkpoint, empty if there is none; the same on every rank. Collective.
  std::string latest() const;

  /// Goes on behind the checkpoints that are there; without it they are dropped as soon as the
  /// first new one is complete.
  void go_on();

  /// Writes a checkpoint and drops the oldest; collective. Throws like CheckpointWriter::write.
  /// @return its path
  std::string write(CheckpointWriter &writer, unsigned long long step);

private:
  std::vector<std::string> listed() const;
  void remove_all_but(const std::vector<std::string> &names) const;
  std::string index() const { return folder + "/" + name + ".latest"; }

  const std::string folder, name;
  const unsigned int keep;
  MPI_Comm comm;
  std::vector<std::string> files; ///< names, the newest first; on the first rank
};

} // namespace eunoe

#endif
