#ifndef eunoe_core_run_lock_h
#define eunoe_core_run_lock_h

#include <mpi.h>
#include <string>

namespace eunoe {

/// Keeps other runs out of a place for as long as it lives, on all nodes that share the file
/// system.
///
/// It is a lock of the kernel on a file, which ends with the process however that ends: a run that
/// was killed keeps nobody out, even if it left its file behind. Runs of one process, as tests and
/// scripts have them, do not keep each other out.
class RunLock
{
public:
  /// Collective. Throws a UserError on every rank if another run holds the lock.
  /// @param path of the file, which says who holds it
  /// @param what is locked, as a sentence begins
  /// @param mend what the user can do, a sentence
  RunLock(const std::string &path, const std::string &what, const std::string &mend, MPI_Comm comm);
  /// Removes the file.
  ~RunLock();
  RunLock(const RunLock &) = delete;
  RunLock &operator=(const RunLock &) = delete;

  /// Why the file system gave no lock, so that nobody is kept out; empty if it did. On the first
  /// rank only.
  const std::string &weakness() const { return why_not; }

private:
  /// Tries to lock the file; to be called by the first rank.
  /// @return whether another run holds it
  bool is_held_by_other();
  void sign() const;
  std::string holder() const;

  const std::string path;
  int handle = -1; ///< of the file that is locked
  std::string why_not;
};

} // namespace eunoe

#endif
