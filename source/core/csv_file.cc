#include <eunoe/core/csv_file.h>
#include <eunoe/core/problems.h>

#include <cmath>
#include <filesystem>

namespace eunoe {

namespace {
const std::string cannot_be_written =
    " cannot be written. Check the folder's permissions and the free space.";
} // namespace

CsvFile::CsvFile(const std::string &path, const std::vector<std::string> &columns, MPI_Comm comm,
                 const std::uint64_t keep)
    : path(path), comm(comm)
{
  if (path.empty())
    return;
  int rank;
  MPI_Comm_rank(comm, &rank);
  bool ok = true;
  if (rank == 0 && keep > 0) {
    std::error_code failure;
    const std::uint64_t size = std::filesystem::file_size(path, failure);
    ok = !failure && size >= keep;
    if (ok)
      std::filesystem::resize_file(path, keep, failure);
    file = ok && !failure ? std::fopen(path.c_str(), "a") : nullptr;
    ok = file != nullptr;
  } else if (rank == 0) {
    file = std::fopen(path.c_str(), "w");
    ok = file != nullptr;
    for (std::size_t c = 0; ok && c < columns.size(); ++c)
      std::fprintf(file, "%s%s", c > 0 ? "," : "", columns[c].c_str());
    ok = ok && std::fputc('\n', file) != EOF && std::fflush(file) == 0;
  }
  check(ok, keep > 0 ? " cannot be continued: it lacks rows that were there at the checkpoint, or "
                       "it cannot be written. Put it back, or start anew with 'restart = false'."
                     : cannot_be_written);
}

std::uint64_t CsvFile::size() const
{
  return file == nullptr ? 0 : static_cast<std::uint64_t>(std::ftell(file));
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
  bool ok = true;
  if (file != nullptr) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0)
        std::fputc(',', file);
      if (!std::isnan(row[c]))
        std::fprintf(file, "%.17g", row[c]);
    }
    ok = std::fputc('\n', file) != EOF && std::fflush(file) == 0;
  }
  check(ok, cannot_be_written);
}

void CsvFile::check(const bool ok, const std::string &what) const
{
  int all_ok = ok ? 1 : 0;
  MPI_Bcast(&all_ok, 1, MPI_INT, 0, comm);
  if (all_ok == 0)
    throw UserError(path + what);
}

} // namespace eunoe
