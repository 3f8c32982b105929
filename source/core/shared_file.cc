#include <eunoe/core/first_rank.h>
#include <eunoe/core/new_file.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/shared_file.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace eunoe {

SharedFile::SharedFile(const std::string &path, MPI_Comm comm)
    : comm(comm), path(path), beside(path + ".new")
{
  constexpr mode_t for_all = 0666; // less the user's mask
  const bool is_first = is_first_rank(comm);
  if (is_first)
    handle = open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC, for_all);
  MPI_Barrier(comm);
  if (!is_first)
    handle = open(beside.c_str(), O_WRONLY);
  note(handle >= 0);
  if (!is_first && handle < 0 && errno == ENOENT)
    error = "another node does not see it, so the folder is not shared by all nodes";
}

SharedFile::~SharedFile()
{
  if (handle >= 0)
    close(handle);
  if (!is_complete && is_first_rank(comm))
    std::remove(beside.c_str());
}

void SharedFile::note(const bool ok)
{
  if (!ok && error.empty())
    error = std::strerror(errno);
}

void SharedFile::protect(const std::uint64_t begin, const std::uint64_t n)
{
  struct flock range = {};
  range.l_type = F_WRLCK;
  range.l_whence = SEEK_SET;
  range.l_start = static_cast<off_t>(begin);
  range.l_len = static_cast<off_t>(n);
  // No two ranks write the same bytes, so that there is nothing to wait for.
  fcntl(handle, F_SETLK, &range);
}

void SharedFile::write(std::uint64_t begin, const void *const data, const std::uint64_t n)
{
  if (n > 0 && handle >= 0)
    protect(begin, n);
  const char *from = static_cast<const char *>(data);
  for (std::uint64_t left = n; left > 0 && error.empty();) {
    const ssize_t written = pwrite(handle, from, left, static_cast<off_t>(begin));
    if (written < 0 && errno == EINTR)
      continue;
    note(written > 0);
    if (written > 0) {
      begin += static_cast<std::uint64_t>(written);
      from += written;
      left -= static_cast<std::uint64_t>(written);
    }
  }
}

void SharedFile::complete(const bool sync)
{
  if (handle >= 0) {
    if (sync && error.empty())
      if (const int failure = sync_file(handle); failure != 0)
        error = std::strerror(failure);
    // Some file systems say only here that there was no space.
    note(close(handle) == 0);
    handle = -1;
  }
  on_every_rank(comm, [&] {
    if (!error.empty())
      throw UserError(cannot_be_written(path, error));
  });
  on_first_rank(comm, [&] {
    note(std::rename(beside.c_str(), path.c_str()) == 0);
    if (!error.empty())
      throw UserError(cannot_be_written(path, error));
    if (sync)
      sync_folder_of(path);
  });
  is_complete = true;
}

} // namespace eunoe
