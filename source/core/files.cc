#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/messages.h>
#include <eunoe/core/new_file.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/quoted_text.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace eunoe {

namespace fs = std::filesystem;

std::string broadcast(std::string text, MPI_Comm comm, const int from)
{
  unsigned long long size = text.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, from, comm);
  text.resize(size);
  constexpr unsigned long long part = 1u << 30;
  for (unsigned long long first = 0; first < size; first += part)
    MPI_Bcast(&text[first], static_cast<int>(std::min(part, size - first)), MPI_CHAR, from, comm);
  return text;
}

std::string read_file(const std::string &path, MPI_Comm comm)
{
  std::string text, error;
  if (is_first_rank(comm)) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream all;
    if (fs::is_directory(path))
      error = "it is a folder";
    else if (fs::is_character_file(path) || fs::is_block_file(path))
      error = "it is a device"; // of which some never end
    else if (!stream)
      error = std::strerror(errno);
    else if (stream.peek() != std::ifstream::traits_type::eof()) {
      all << stream.rdbuf();
      text = all.str();
      if (!stream)
        error = "reading failed";
    }
  }
  error = broadcast(error, comm);
  if (!error.empty())
    throw UserError(shortened(path) + " cannot be read: " + error +
                    ". Check the name and the permissions.");
  return broadcast(text, comm);
}

void write_file(const std::string &path, const std::string &text, const bool sync)
{
  NewFile file(path);
  file.write(text.data(), text.size());
  file.complete(sync);
}

void write_in_turn(const std::string &path, const std::string &mine, MPI_Comm comm)
{
  constexpr int tag_size = 331, tag_text = 332;
  std::uint64_t size = mine.size();
  if (!is_first_rank(comm)) {
    MPI_Send(&size, 1, MPI_UINT64_T, 0, tag_size, comm);
    send(mine.data(), size, 0, tag_text, comm);
  }
  on_first_rank(comm, [&] {
    int n_ranks;
    MPI_Comm_size(comm, &n_ranks);
    NewFile file(path);
    file.write(mine.data(), mine.size());
    std::string text;
    for (int rank = 1; rank < n_ranks; ++rank) {
      MPI_Recv(&size, 1, MPI_UINT64_T, rank, tag_size, comm, MPI_STATUS_IGNORE);
      text.resize(size);
      receive(text.data(), size, rank, tag_text, comm);
      file.write(text.data(), size);
    }
    file.complete(false);
  });
}

double file_size(const std::string &path)
{
  std::error_code failure;
  const auto size = fs::file_size(path, failure);
  return failure ? 0. : static_cast<double>(size);
}

void remove_file(const std::string &path)
{
  std::error_code failure;
  fs::remove(path, failure);
}

void create_folder(const std::string &path, MPI_Comm comm)
{
  on_first_rank(comm, [&] {
    std::error_code failure;
    std::string error;
    fs::create_directories(path, failure);
    const std::string probe = path + "/.eunoe-probe";
    if (failure)
      error = failure.message();
    else if (!std::ofstream(probe))
      error = std::strerror(errno);
    fs::remove(probe, failure);
    if (!error.empty())
      throw UserError("The folder " + shortened(path) + " cannot be written to: " + error +
                      ". Choose another folder, or mend the permissions.");
  });
}

int Table::column(const std::string &name) const
{
  const auto it = std::find(columns.begin(), columns.end(), name);
  return it == columns.end() ? -1 : static_cast<int>(it - columns.begin());
}

Table parse_table(const std::string &text, const std::string &file)
{
  Table table;
  std::istringstream stream(text);
  std::string line;
  unsigned int number = 0;
  char separator = ';';
  if (text.compare(0, byte_order_mark.size(), byte_order_mark) == 0)
    stream.ignore(static_cast<std::streamsize>(byte_order_mark.size()));
  while (std::getline(stream, line)) {
    ++number;
    boost::trim(line);
    if (line.empty() || line[0] == '#')
      continue;
    if (table.columns.empty() && line.find(';') == std::string::npos)
      separator = ',';
    std::vector<std::string> cells;
    boost::split(cells, line, [&](char c) { return c == separator; });
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
  if (table.columns.empty())
    throw UserError(file + ": it has no header line. Name the columns in the first line.");
  return table;
}

} // namespace eunoe
