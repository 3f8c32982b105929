#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/messages.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/table.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <sstream>

namespace eunoe {

int Table::column(const std::string &name) const
{
  const auto it = std::find(columns.begin(), columns.end(), name);
  return it == columns.end() ? -1 : static_cast<int>(it - columns.begin());
}

namespace {

/// Whole lines of a text file.
struct FilePart
{
  std::string text;
  std::uint64_t first_line = 1; ///< its number in the file
};

/// Adds the rows of whole lines to a table, and its columns if it has none yet.
void parse_lines(const FilePart &part, const std::string &file, Table &table)
{
  std::istringstream stream(part.text);
  std::string line;
  std::uint64_t number = part.first_line - 1;
  if (number == 0 && part.text.compare(0, byte_order_mark.size(), byte_order_mark) == 0)
    stream.ignore(static_cast<std::streamsize>(byte_order_mark.size()));
  while (std::getline(stream, line)) {
    ++number;
    boost::trim(line);
    if (line.empty() || line[0] == '#')
      continue;
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
      continue;
    }
    const std::string where = file + ":" + std::to_string(number) + ": ";
    if (cells.size() != table.columns.size())
      throw UserError(where + "there are " + std::to_string(cells.size()) +
                      " values under a header of " + std::to_string(table.columns.size()) +
                      " columns. Give one value a column.");
    std::vector<double> row;
    for (const std::string &cell : cells) {
      char *end;
      row.push_back(std::strtod(cell.c_str(), &end));
      if (cell.empty() || *end != '\0')
        throw UserError(where + "'" + cell.substr(0, 40) + "' is not a number.");
    }
    table.rows.push_back(row);
  }
}

void require_columns(const Table &table, const std::string &file)
{
  if (table.columns.empty())
    throw UserError(file + ": it has no header line. Name the columns in the first line.");
}

/// Reads a file in parts of whole lines.
class PartReader
{
public:
  PartReader(const std::string &path, const std::uint64_t n_bytes)
      : path(path), stream(open_for_reading(path)), n_bytes(n_bytes)
  {
  }

  /// The lines that end before about @p end bytes of the file, or with the first after it.
  FilePart read_to(const std::uint64_t end)
  {
    FilePart part;
    part.first_line = next_line;
    if (read < end) {
      part.text.resize(end - read);
      stream.read(&part.text[0], static_cast<std::streamsize>(part.text.size()));
      part.text.resize(static_cast<std::size_t>(stream.gcount()));
      std::string rest;
      if (!part.text.empty() && part.text.back() != '\n' && std::getline(stream, rest)) {
        part.text += rest;
        if (!stream.eof())
          part.text += '\n';
      }
    }
    if (end >= n_bytes) {
      // What has no known size, such as a pipe, is read to its end.
      std::ostringstream all;
      if (stream && stream.peek() != std::ifstream::traits_type::eof())
        all << stream.rdbuf();
      part.text += all.str();
    }
    if (stream.bad())
      throw UserError(path + ": reading failed. Check the disk.");
    read += part.text.size();
    next_line += static_cast<std::uint64_t>(std::count(part.text.begin(), part.text.end(), '\n'));
    return part;
  }

  /// Reads lines until the table has its columns.
  void read_columns(Table &table)
  {
    std::string line;
    while (table.columns.empty() && std::getline(stream, line)) {
      parse_lines({line, next_line}, path, table);
      read += line.size() + 1;
      ++next_line;
    }
    require_columns(table, path);
  }

private:
  const std::string path;
  std::ifstream stream;
  const std::uint64_t n_bytes;
  std::uint64_t read = 0, next_line = 1;
};

constexpr int tag_line = 333, tag_size = 334, tag_text = 335;

void send_part(const FilePart &part, const int rank, MPI_Comm comm)
{
  const std::uint64_t size = part.text.size();
  MPI_Send(&part.first_line, 1, MPI_UINT64_T, rank, tag_line, comm);
  MPI_Send(&size, 1, MPI_UINT64_T, rank, tag_size, comm);
  send(part.text.data(), size, rank, tag_text, comm);
}

FilePart receive_part(MPI_Comm comm)
{
  FilePart part;
  std::uint64_t size;
  MPI_Recv(&part.first_line, 1, MPI_UINT64_T, 0, tag_line, comm, MPI_STATUS_IGNORE);
  MPI_Recv(&size, 1, MPI_UINT64_T, 0, tag_size, comm, MPI_STATUS_IGNORE);
  part.text.resize(size);
  receive(part.text.data(), size, 0, tag_text, comm);
  return part;
}

/// Reads the columns of a table and gives every other rank its part of the lines, an empty one
/// where reading fails. To be called by the first rank.
FilePart hand_out(const std::string &path, Table &table, MPI_Comm comm)
{
  int n_ranks, next = 1;
  MPI_Comm_size(comm, &n_ranks);
  FilePart mine;
  try {
    const auto n_bytes = static_cast<std::uint64_t>(file_size(path));
    PartReader reader(path, n_bytes);
    reader.read_columns(table);
    mine = reader.read_to(n_bytes / static_cast<std::uint64_t>(n_ranks));
    for (; next < n_ranks; ++next)
      send_part(reader.read_to(n_bytes * static_cast<std::uint64_t>(next + 1) /
                               static_cast<std::uint64_t>(n_ranks)),
                next, comm);
  } catch (const UserError &) {
    for (; next < n_ranks; ++next)
      send_part({}, next, comm);
    throw;
  }
  return mine;
}

} // namespace

Table parse_table(const std::string &text, const std::string &file)
{
  Table table;
  parse_lines({text, 1}, file, table);
  require_columns(table, file);
  return table;
}

Table read_table_in_parts(const std::string &path, MPI_Comm comm)
{
  Table columns, part;
  FilePart mine;
  if (!is_first_rank(comm))
    mine = receive_part(comm);
  on_first_rank(comm, [&] { mine = hand_out(path, columns, comm); });
  const std::string separator(1, columns.separator);
  parse_lines({broadcast(boost::join(columns.columns, separator), comm), 1}, path, part);
  on_every_rank(comm, [&] { parse_lines(mine, path, part); });
  return part;
}

} // namespace eunoe
