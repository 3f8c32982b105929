// Tables of which every rank reads a part.

#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/message_tags.h>
#include <eunoe/core/messages.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/quoted_text.h>

#include "table_line.h"
#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <sstream>

namespace eunoe {

namespace {

/// Where a table's rows begin.
struct Beginning
{
  Table columns;
  std::uint64_t line = 1, byte = 0; ///< of the line behind the header
};

/// Reads lines until the table has its columns.
Beginning read_beginning(const std::string &path, std::istream &stream)
{
  Beginning found;
  std::vector<double> none;
  for (std::string line; found.columns.columns.empty() && std::getline(stream, line); ++found.line)
  {
    found.byte += line.size() + 1;
    if (found.line == 1 && line.compare(0, byte_order_mark.size(), byte_order_mark) == 0)
      line.erase(0, byte_order_mark.size());
    read_line(line, found.columns, none);
  }
  if (found.columns.columns.empty())
    throw UserError(path + ": it has no header line. Name the columns in the first line.");
  return found;
}

/// Gives the beginning that the first rank has read to every rank; collective.
void share_beginning(Beginning &beginning, MPI_Comm comm)
{
  std::array<std::uint64_t, 2> numbers = {{beginning.line, beginning.byte}};
  MPI_Bcast(numbers.data(), 2, MPI_UINT64_T, 0, comm);
  beginning.line = numbers[0];
  beginning.byte = numbers[1];
  const std::string separator(1, beginning.columns.separator);
  const std::string header = broadcast(boost::join(beginning.columns.columns, separator), comm);
  beginning.columns.columns.clear();
  std::vector<double> none;
  read_line(header, beginning.columns, none);
}

/// Gives the rows of a rank's lines to those who want them.
class RowReader
{
public:
  RowReader(const Table &columns, const TakeRow &take) : columns(columns), take(take) {}

  /// @param end of the bytes in which lines begin that are read
  void read(std::istream &stream, const std::uint64_t begin, const std::uint64_t end)
  {
    std::string line;
    std::vector<double> row;
    for (std::uint64_t at = begin; at < end && std::getline(stream, line);) {
      at += line.size() + 1;
      ++n_lines;
      if (read_line(line, columns, row))
        take(columns, row);
    }
  }

  Table columns;
  std::uint64_t n_lines = 0; ///< read so far

private:
  const TakeRow &take;
};

/// Throws on every rank what is wrong with the first wrong line of all, with its number;
/// collective.
/// @param first number of the first line of the first rank
/// @param wrong what is wrong with the last line that was read here, empty if nothing
void refuse_wrong_line(const std::string &path, const std::uint64_t first,
                       const std::uint64_t n_lines, const std::string &wrong, MPI_Comm comm)
{
  std::uint64_t before = 0;
  MPI_Exscan(&n_lines, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
  if (is_first_rank(comm))
    before = 0; // which MPI leaves undefined
  on_every_rank(comm, [&] {
    if (!wrong.empty())
      throw UserError(path + ":" + std::to_string(first + before + n_lines - 1) + ": " + wrong);
  });
}

/// Size of a file that every rank sees, and sees alike (bytes); collective.
/// @return 0 if there are ranks that do not, or if it is no file with a size, such as a pipe
std::uint64_t size_seen_by_all(const std::string &path, MPI_Comm comm)
{
  std::error_code failure;
  const bool is_file = std::filesystem::is_regular_file(path, failure);
  const std::uint64_t size =
      is_file && std::ifstream(path) ? static_cast<std::uint64_t>(file_size(path)) : 0;
  std::array<std::uint64_t, 2> ends = {{size, ~size}};
  MPI_Allreduce(MPI_IN_PLACE, ends.data(), 2, MPI_UINT64_T, MPI_MIN, comm);
  return ends[0] == ~ends[1] ? size : 0;
}

/// This rank's part of a file; the whole one for all ranks together. A line belongs to the rank in
/// whose part it begins.
void read_at_offset(const std::string &path, const std::uint64_t size, const Beginning &beginning,
                    RowReader &reader, MPI_Comm comm)
{
  int rank, n_ranks;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);
  const std::uint64_t n = size - std::min(size, beginning.byte);
  const auto start = [&](const int r) {
    // The product with a number of ranks stays below 2^64 up to files of a hundred terabytes.
    return beginning.byte + n * static_cast<std::uint64_t>(r) / static_cast<std::uint64_t>(n_ranks);
  };
  std::ifstream stream = open_for_reading(path);
  std::uint64_t begin = start(rank);
  if (rank > 0) {
    // What is left of a line that began before.
    stream.seekg(static_cast<std::streamoff>(begin - 1));
    std::string rest;
    std::getline(stream, rest);
    begin += rest.size();
  } else
    stream.seekg(static_cast<std::streamoff>(begin));
  reader.read(stream, begin, start(rank + 1));
  if (stream.bad())
    throw UserError(path + ": reading failed. Check the disk.");
}

/// Sends every other rank its part of the lines of a stream. To be called by the first rank.
/// @param at bytes of the file that have been read
/// @param size of the file (bytes); 0 if it has none, such as a pipe: then the last rank gets all
/// @return the first rank's own part
std::string hand_out(std::istream &stream, const std::uint64_t at, const std::uint64_t size,
                     MPI_Comm comm)
{
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  const std::uint64_t n = size - std::min(size, at);
  std::string own;
  std::uint64_t read = 0;
  for (int r = 0; r < n_ranks; ++r) {
    const std::uint64_t end =
        n * static_cast<std::uint64_t>(r + 1) / static_cast<std::uint64_t>(n_ranks);
    std::string text(end - std::min(end, read), ' '), rest;
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (!text.empty() && text.back() != '\n' && std::getline(stream, rest))
      text += rest + '\n';
    if (r == n_ranks - 1 && stream && stream.peek() != std::istream::traits_type::eof())
      text.append(std::istreambuf_iterator<char>(stream), {});
    read += text.size();
    if (r == 0)
      own = std::move(text);
    else {
      const std::uint64_t length = text.size();
      MPI_Send(&length, 1, MPI_UINT64_T, r, tag_table_size, comm);
      send(text.data(), length, r, tag_table_text, comm);
    }
  }
  return own;
}

std::string receive_part(MPI_Comm comm)
{
  std::uint64_t size;
  MPI_Recv(&size, 1, MPI_UINT64_T, 0, tag_table_size, comm, MPI_STATUS_IGNORE);
  std::string text(size, ' ');
  receive(text.data(), size, 0, tag_table_text, comm);
  return text;
}

} // namespace

Table read_table_in_parts(const std::string &path, MPI_Comm comm, const TakeRow &take)
{
  const std::uint64_t size = size_seen_by_all(path, comm);
  Beginning beginning;
  std::ifstream stream;
  on_first_rank(comm, [&] {
    stream = open_for_reading(path);
    beginning = read_beginning(path, stream);
  });
  share_beginning(beginning, comm);
  std::string part, wrong, failure;
  if (size == 0)
    part = is_first_rank(comm)
               ? hand_out(stream, beginning.byte, static_cast<std::uint64_t>(file_size(path)), comm)
               : receive_part(comm);
  if (stream.bad())
    failure = path + ": reading failed. Check the disk.";
  stream.close();
  RowReader reader(beginning.columns, take);
  try {
    if (size > 0)
      read_at_offset(path, size, beginning, reader, comm);
    else {
      std::istringstream lines(part);
      reader.read(lines, 0, part.size());
    }
  } catch (const WrongLine &problem) {
    wrong = problem.what();
  } catch (const UserError &problem) {
    failure = problem.what();
  }
  refuse_wrong_line(path, beginning.line, reader.n_lines, wrong, comm);
  on_every_rank(comm, [&] {
    if (!failure.empty())
      throw UserError(failure);
  });
  return beginning.columns;
}

} // namespace eunoe
