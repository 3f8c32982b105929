#include <eunoe/core/new_file.h>
#include <eunoe/core/problems.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>

namespace eunoe {

namespace {

int sync_path(const std::string &path)
{
  const int handle = open(path.c_str(), O_RDONLY);
  if (handle < 0)
    return errno;
  const int failure = sync_file(handle);
  close(handle);
  return failure;
}

} // namespace

std::string cannot_be_written(const std::string &path, const std::string &error)
{
  return path + " cannot be written: " + error +
         ". Check the folder's permissions and the free space.";
}

int sync_file(const int handle)
{
  const int failure = fsync(handle) == 0 ? 0 : errno;
  // Files without a disk, such as pipes, cannot be synced, nor can those of some file systems.
  const bool is_unable =
      failure == EINVAL || failure == EROFS || failure == ENOSYS || failure == ENOTSUP;
  return is_unable ? 0 : failure;
}

void sync_file(const std::string &path)
{
  const int failure = sync_path(path);
  if (failure != 0 && failure != ENOENT)
    throw UserError(cannot_be_written(path, std::strerror(failure)));
}

void sync_file(std::FILE *const file, const std::string &path)
{
  const int failure = sync_file(fileno(file));
  if (failure != 0)
    throw UserError(cannot_be_written(path, std::strerror(failure)));
}

void sync_folder_of(const std::string &path)
{
  const std::string folder = std::filesystem::path(path).parent_path().string();
  // Not every file system can do this, and those that cannot do not need it.
  sync_path(folder.empty() ? "." : folder);
}

NewFile::NewFile(const std::string &path)
    : path(path), beside(path + ".new"), file(std::fopen(beside.c_str(), "wb"))
{
  note(file != nullptr);
  if (file == nullptr)
    beside.clear();
}

NewFile::~NewFile()
{
  if (file != nullptr)
    std::fclose(file);
  if (!beside.empty())
    std::remove(beside.c_str());
}

void NewFile::note(const bool ok)
{
  if (!ok && error.empty())
    error = std::strerror(errno);
}

void NewFile::write(const void *data, const std::uint64_t n)
{
  if (n > 0 && error.empty())
    note(std::fwrite(data, 1, n, file) == n);
}

void NewFile::complete(const bool sync)
{
  if (file != nullptr) {
    note(std::fflush(file) == 0);
    if (sync && error.empty()) {
      const int failure = sync_file(fileno(file));
      if (failure != 0)
        error = std::strerror(failure);
    }
    // Some file systems say only here that there was no space.
    note(std::fclose(file) == 0);
    file = nullptr;
  }
  if (error.empty())
    note(std::rename(beside.c_str(), path.c_str()) == 0);
  if (!error.empty())
    throw UserError(cannot_be_written(path, error));
  beside.clear();
  if (sync)
    sync_folder_of(path);
}

} // namespace eunoe
