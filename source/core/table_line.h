#ifndef eunoe_source_core_table_line_h
#define eunoe_source_core_table_line_h

#include <eunoe/core/table.h>

#include <stdexcept>

namespace eunoe {

/// What is wrong with a line, a sentence.
struct WrongLine : public std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Reads a line of a table: a row, or its columns if it has none yet. Throws a WrongLine.
/// @param row the numbers
/// @return whether there is a row
bool read_line(std::string line, Table &table, std::vector<double> &row);

} // namespace eunoe

#endif
