#include <eunoe/core/problems.h>
#include <eunoe/core/quoted_text.h>

#include "table_line.h"
#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <sstream>

namespace eunoe {

int Table::column(const std::string &name) const
{
  const auto it = std::find(columns.begin(), columns.end(), name);
  return it == columns.end() ? -1 : static_cast<int>(it - columns.begin());
}

bool read_line(std::string line, Table &table, std::vector<double> &row)
{
  boost::trim(line);
  if (line.empty() || line[0] == '#')
    return false;
  if (table.columns.empty() && line.find(';') == std::string::npos)
    table.separator = ',';
  std::vector<std::string> cells;
  boost::split(cells, line, [&](char c) { return c == table.separator; });
  for (std::string &cell : cells)
    boost::trim(cell);
  if (cells.back().empty())
    cells.pop_back();
  if (table.columns.empty()) {
    table.columns = cells;
    return false;
  }
  if (cells.size() != table.columns.size())
    throw WrongLine("there are " + std::to_string(cells.size()) + " values under a header of " +
                    std::to_string(table.columns.size()) + " columns. Give one value a column.");
  row.clear();
  for (const std::string &cell : cells) {
    char *end;
    row.push_back(std::strtod(cell.c_str(), &end));
    if (cell.empty() || *end != '\0')
      throw WrongLine("'" + cell.substr(0, 40) + "' is not a number.");
  }
  return true;
}

Table parse_table(const std::string &text, const std::string &file)
{
  Table table;
  std::istringstream stream(text);
  if (text.compare(0, byte_order_mark.size(), byte_order_mark) == 0)
    stream.ignore(static_cast<std::streamsize>(byte_order_mark.size()));
  std::vector<double> row;
  std::uint64_t number = 1;
  for (std::string line; std::getline(stream, line); ++number)
    try {
      if (read_line(line, table, row))
        table.rows.push_back(row);
    } catch (const WrongLine &problem) {
      throw UserError(file + ":" + std::to_string(number) + ": " + problem.what());
    }
  if (table.columns.empty())
    throw UserError(file + ": it has no header line. Name the columns in the first line.");
  return table;
}

} // namespace eunoe
