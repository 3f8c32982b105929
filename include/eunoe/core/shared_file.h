#ifndef eunoe_core_shared_file_h
#define eunoe_core_shared_file_h

#include <cstdint>
#include <mpi.h>
#include <string>

namespace eunoe {

/// A file that all ranks write, each its own parts, beside the old one of its name. It takes the
/// place of that when it is complete, so that no half-written file is left.
class SharedFile
{
public:
  /// Collective. Errors are kept for `complete`.
  SharedFile(const std::string &path, MPI_Comm comm);
  /// Removes what was not completed.
  ~SharedFile();
  SharedFile(const SharedFile &) = delete;
  SharedFile &operator=(const SharedFile &) = delete;

  /// Writes @p n bytes from the byte @p begin of the file on.
  void write(std::uint64_t begin, const void *data, std::uint64_t n);

  /// Gives the file its name; collective. Throws a UserError on every rank if a rank could not
  /// write its parts; then the old file is as it was.
  /// @param sync waits until the file and its name would survive a crash of the machine
  void complete(bool sync = true);

private:
  void note(bool ok);
  /// Locks bytes until the file is closed, where the file system has locks. A client of NFS fills a
  /// page beyond the end that it knows with zeros and writes all of it, over what another node has
  /// written there, unless bytes of the file are locked.
  void protect(std::uint64_t begin, std::uint64_t n);

  MPI_Comm comm;
  const std::string path, beside;
  int handle = -1;
  bool is_complete = false;
  std::string error; ///< the first one here
};

} // namespace eunoe

#endif
