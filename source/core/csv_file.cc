#include <eunoe/core/csv_file.h>
#include <eunoe/core/problems.h>

#include <cmath>

namespace eunoe {

CsvFile::CsvFile(const std::string &path, const std::vector<std::string> &columns, MPI_Comm comm)
    : path(path), comm(comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  bool ok = true;
  if (rank == 0) {
    file = std::fopen(path.c_str(), "w");
    ok = file != nullptr;
    for (std::size_t c = 0; ok && c < columns.size(); ++c)
      std::fprintf(file, "%s%s", c > 0 ? "," : "", columns[c].c_str());
    ok = ok && std::fputc('\n', file) != EOF && std::fflush(file) == 0;
  }
  check(ok);
}

CsvFile::~CsvFile()
{
  if (file != nullptr)
    std::fclose(file);
}

void CsvFile::write(const std::vector<double> &row)
{
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
  check(ok);
}

void CsvFile::check(const bool ok) const
{
  int all_ok = ok ? 1 : 0;
  MPI_Bcast(&all_ok, 1, MPI_INT, 0, comm);
  if (all_ok == 0)
    throw UserError(path + " cannot be written. Check the folder's permissions and the free "
                           "space.");
}

} // namespace eunoe
