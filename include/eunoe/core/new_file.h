#ifndef eunoe_core_new_file_h
#define eunoe_core_new_file_h

#include <cstdint>
#include <cstdio>
#include <string>

namespace eunoe {

/// A file that is written beside the old one of its name and takes its place when it is complete,
/// so that no half-written file is left. To be used by one rank.
class NewFile
{
public:
  explicit NewFile(const std::string &path);
  /// Removes what was not completed.
  ~NewFile();
  NewFile(const NewFile &) = delete;
  NewFile &operator=(const NewFile &) = delete;

  /// Keeps an error for `complete`, as other ranks may still be sending what comes next.
  void write(const void *data, std::uint64_t n);

  /// Throws a UserError if the file could not be written; then the old one is as it was.
  /// @param sync waits until the file and its name would survive a crash of the machine
  void complete(bool sync);

private:
  void note(bool ok);

  const std::string path;
  std::string beside; ///< empty once it is complete
  std::FILE *file;
  std::string error;
};

/// Waits until a file would survive a crash of the machine. Throws a UserError if it would not; a
/// file that was removed meanwhile is ignored.
void sync_file(const std::string &path);
void sync_file(std::FILE *file, const std::string &path);
/// The same for an open file.
/// @return 0, or the number of the error
int sync_file(int handle);

/// The same for the names of the files in the folder of @p path.
void sync_folder_of(const std::string &path);

/// How a file is refused that cannot be written, for the reason in @p error.
std::string cannot_be_written(const std::string &path, const std::string &error);

} // namespace eunoe

#endif
