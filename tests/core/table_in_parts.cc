// A table of which every rank reads a part: together they are the table that one rank reads,
// whatever its lines look like, and a line that is wrong is named by its number on every rank.

#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/table.h>

#include "../tests.h"

using namespace test;

namespace {

const std::string path = "table.csv";

void write(const std::string &text)
{
  on_first_rank(MPI_COMM_WORLD, [&] { write_file(path, text); });
}

/// Rows with numbers of different lengths, comments and empty lines in between.
std::string lines(const unsigned int n, const std::string &end)
{
  std::string text;
  for (unsigned int k = 0; k < n; ++k) {
    text += std::to_string(k) + "; " + (k % 3 == 0 ? "1e-5" : "0.123456789") + end;
    if (k % 7 == 0)
      text += "# a remark that is longer than a row of the table" + end;
    if (k % 5 == 0)
      text += end;
  }
  return text;
}

void check_parts(const std::string &name, const std::string &text)
{
  write(text);
  const Table whole = parse_table(text, path);
  std::vector<std::vector<double>> mine;
  const Table part =
      read_table_in_parts(path, MPI_COMM_WORLD, [&](const Table &, const std::vector<double> &row) {
        mine.push_back(row);
      });
  test::check(name + ": the same rows", test::of_all_ranks(MPI_COMM_WORLD, mine) == whole.rows &&
                                            part.columns == whole.columns);
  auto largest = static_cast<double>(mine.size());
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  int n_ranks;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  if (whole.rows.size() > 100)
    test::check(name + ": in about equal parts", largest < 1.2 * whole.rows.size() / n_ranks);
}

void leave(const Table &, const std::vector<double> &) {}

/// A file that only the first rank sees: it hands out the parts.
void check_one_reader()
{
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const std::string text = "n; x\n" + lines(1000, "\n");
  write(text);
  std::vector<std::vector<double>> mine;
  read_table_in_parts(rank == 0 ? path : "nowhere/" + path, MPI_COMM_WORLD,
                      [&](const Table &, const std::vector<double> &row) { mine.push_back(row); });
  const auto all = test::of_all_ranks(MPI_COMM_WORLD, mine);
  bool ok = all.size() == 1000;
  for (std::size_t k = 0; ok && k < all.size(); ++k)
    ok = all[k][0] == static_cast<double>(k);
  test::check("seen by the first rank only", ok);
}

void print_refusal(const std::string &text)
{
  write(text);
  try {
    read_table_in_parts(path, MPI_COMM_WORLD, leave);
    test::print("taken");
  } catch (const UserError &error) {
    test::print(error.what());
  }
}

} // namespace

EUNOE_MPI_TEST()
{
  check_parts("many rows", "n; x\n" + lines(1000, "\n"));
  check_parts("lines end as in DOS", "# made by hand\r\n\r\nn; x\r\n" + lines(1000, "\r\n"));
  check_parts("no end of the last line", "n, x\n1, 2\n3, 4");
  check_parts("fewer rows than ranks", "n; x;\n1; 2;\n");
  check_parts("no rows", "n; x\n");
  check_one_reader();
  std::string wrong = "n; x\n" + lines(1000, "\n");
  print_refusal(wrong + "1; 2; 3\n");
  print_refusal(wrong + "1; two\n" + lines(500, "\n"));
  print_refusal("# nothing\n");
  on_first_rank(MPI_COMM_WORLD, [] { remove_file(path); });
  try {
    read_table_in_parts(path, MPI_COMM_WORLD, leave);
  } catch (const UserError &error) {
    test::print(error.what());
  }
}
