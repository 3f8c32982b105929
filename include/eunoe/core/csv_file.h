#ifndef eunoe_core_csv_file_h
#define eunoe_core_csv_file_h

#include <cstdint>
#include <cstdio>
#include <mpi.h>
#include <string>
#include <vector>

namespace eunoe {

/// A table that grows row by row, written by the first rank of a communicator; every row can be
/// read when `write` returns. Without a path nothing is written.
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

  /// Waits until the rows would survive a crash of the machine. To be called by the first rank,
  /// throws a UserError there.
  void sync() const;

private:
  /// To be called by the first rank.
  void append(const std::string &line);

  const std::string path;
  MPI_Comm comm;
  std::FILE *file = nullptr;  ///< on the first rank
  std::uint64_t complete = 0; ///< bytes of complete rows
};

} // namespace eunoe

#endif
