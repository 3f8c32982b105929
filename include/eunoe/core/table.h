#ifndef eunoe_core_table_h
#define eunoe_core_table_h

#include <mpi.h>
#include <string>
#include <vector>

namespace eunoe {

/// A table in the form "a; b; c;" with a header line: columns by the names of the header.
struct Table
{
  std::vector<std::string> columns;
  char separator = ';';
  std::vector<std::vector<double>> rows;

  /// Place of a column, -1 if there is none of that name.
  int column(const std::string &name) const;
};

/// Reads a table with columns separated by ';' (as Lethe writes them) or ','.
/// Throws a UserError that names the line.
Table parse_table(const std::string &text, const std::string &file);

/// Reads a table of which every rank gets a part of the rows, about equal in bytes and in their
/// order; collective. The first rank reads, and never holds more than a part. Throws a UserError
/// that names the line on every rank.
Table read_table_in_parts(const std::string &path, MPI_Comm comm);

} // namespace eunoe

#endif
