#ifndef eunoe_core_csv_file_h
#define eunoe_core_csv_file_h

#include <cstdint>
#include <cstdio>
#include <mpi.h>
#include <string>
#include <vector>

namespace eunoe {

/// A table that grows row by row, written by the first rank of a communicator; every row is on
/// disk when `write` returns. Without a path it goes nowhere.
class CsvFile
{
public:
  /// Starts the file anew, or goes on behind the first @p keep bytes of an old one. Throws a
  /// UserError on every rank if that fails; collective.
  CsvFile(const std::string &path, const std::vector<std::string> &columns, MPI_Comm comm,
          std::uint64_t keep = 0);
  ~CsvFile();
  CsvFile(const CsvFile &) = delete;
  CsvFile &operator=(const CsvFile &) = delete;

  /// Appends a row with full precision; a NaN stays empty. Collective, throws like the constructor.
  void write(const std::vector<double> &row);

  /// Bytes written, on the first rank.
  std::uint64_t size() const;

private:
  void check(bool ok, const std::string &what) const;

  const std::string path;
  MPI_Comm comm;
  std::FILE *file = nullptr;
};

} // namespace eunoe

#endif
