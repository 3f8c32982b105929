#ifndef eunoe_core_table_h
#define eunoe_core_table_h

#include <functional>
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

/// Takes a row of a table; of the table only the columns are there.
using TakeRow = std::function<void(const Table &columns, const std::vector<double> &row)>;

/// Reads a table of which every rank gets a part of the rows, about equal in bytes and in their
/// order; collective. Where all ranks see the file, each reads its own part of it; else the first
/// rank reads it and hands out the parts. Throws a UserError that names the line on every rank.
/// @param take called for each row of this rank
/// @return the columns
Table read_table_in_parts(const std::string &path, MPI_Comm comm, const TakeRow &take);

} // namespace eunoe

#endif
