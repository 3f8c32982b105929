#include <eunoe/core/csv_file.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/new_file.h>
#include <eunoe/core/problems.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <unistd.h>

namespace eunoe {

namespace {

/// Cuts a table back to its first @p keep bytes, with which a row must end.
void cut_back(const std::string &path, const std::uint64_t keep)
{
  const std::string mend = " Put it back as it was, or start anew with 'restart = false'.";
  std::error_code failure;
  const std::uint64_t size = std::filesystem::file_size(path, failure);
  if (failure)
    throw UserError(path + " cannot be continued: " + failure.message() + "." + mend);
  if (size < keep)
    throw UserError(path + " cannot be continued: it has " + std::to_string(size) +
                    " bytes, and had " + std::to_string(keep) +
                    " at the checkpoint, so rows are missing." + mend);
  std::FILE *const file = std::fopen(path.c_str(), "rb");
  const bool ends_a_row = file != nullptr &&
                          std::fseek(file, static_cast<long>(keep) - 1, SEEK_SET) == 0 &&
                          std::fgetc(file) == '\n';
  if (file != nullptr)
    std::fclose(file);
  if (!ends_a_row)
    throw UserError(path + " cannot be continued: no row ends after its first " +
                    std::to_string(keep) + " bytes, as at the checkpoint; it was changed." + mend);
  std::filesystem::resize_file(path, keep, failure);
  if (failure)
    throw UserError(cannot_be_written(path, failure.message()));
}

} // namespace

CsvFile::CsvFile(const std::string &path, const std::vector<std::string> &columns, MPI_Comm comm,
                 const std::uint64_t keep)
    : path(path), comm(comm)
{
  if (path.empty())
    return;
  on_first_rank(comm, [&] {
    if (keep > 0)
      cut_back(path, keep);
    file = std::fopen(path.c_str(), keep > 0 ? "a" : "w");
    if (file == nullptr)
      throw UserError(cannot_be_written(path, std::strerror(errno)));
    // No part of a row that failed may be written later.
    std::setvbuf(file, nullptr, _IONBF, 0);
    complete = keep;
    std::string line;
    for (std::size_t c = 0; c < columns.size(); ++c)
      line += (c > 0 ? "," : "") + columns[c];
    if (keep == 0)
      append(line + "\n");
  });
}

std::uint64_t CsvFile::size() const
{
  return complete;
}

CsvFile::~CsvFile()
{
  if (file != nullptr)
    std::fclose(file);
}

void CsvFile::write(const std::vector<double> &row)
{
  if (path.empty())
    return;
  on_first_rank(comm, [&] {
    std::string line;
    char value[32];
    for (std::size_t c = 0; c < row.size(); ++c) {
      std::snprintf(value, sizeof value, "%.17g", row[c]);
      line += (c > 0 ? "," : "") + std::string(std::isnan(row[c]) ? "" : value);
    }
    append(line + "\n");
  });
}

void CsvFile::append(const std::string &line)
{
  if (std::fwrite(line.data(), 1, line.size(), file) == line.size()) {
    complete += line.size();
    return;
  }
  const std::string reason = std::strerror(errno);
  // The rows before stay readable.
  const bool is_clean = ftruncate(fileno(file), static_cast<off_t>(complete)) == 0;
  throw UserError(
      cannot_be_written(path, reason + (is_clean ? "" : "; its last row is cut short")));
}

void CsvFile::sync() const
{
  if (file != nullptr)
    sync_file(file, path);
}

} // namespace eunoe
