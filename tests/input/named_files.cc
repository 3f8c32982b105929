// The contents of files that an input names count as the input does, those of files that happen to
// have the name of another value do not.

#include <eunoe/core/files.h>
#include <eunoe/core/named_files.h>
#include <eunoe/core/sha256.h>

#include "../tests.h"

using namespace test;

namespace {

EntryValues digests()
{
  Problems problems;
  const Parameters parameters =
      Parameters::read(box_input(1e-6, 1e-5,
                                 "subsection insertion info\n set insertion method = file\n"
                                 " set list of input files = grains.csv, more_grains\nend\n"),
                       "case.prm", {}, problems);
  return named_files(parameters.file_entries(), MPI_COMM_WORLD);
}

} // namespace

EUNOE_MPI_TEST()
{
  write_file("grains.csv", "of the first event");
  write_file("more_grains", "of the second");
  write_file("custom_distribution.txt", "named by the default");
  // Values of other entries.
  for (const char *const value : {"1", "true", "file", "out", "dealii"})
    write_file(value, "no file of the run");

  const EntryValues found = digests();
  check("two entries name files that are there", found.size() == 2);
  const auto list = found.find({{"insertion info"}, "list of input files"});
  check("a list of files", list != found.end() && list->second == sha256("of the first event") +
                                                                      sha256("of the second"));
  check("a file of a subsection in another one",
        found.count({{"lagrangian physical properties", "particle type 0"},
                     "custom distribution filename"}) == 1);
  write_file("1", "other contents");
  check("other files do not count", digests() == found);
  write_file("more_grains", "of another event");
  check("those that are named do", digests() != found);
  remove_file("grains.csv");
  remove_file("more_grains");
  check("files that are missing are left out", digests().size() == 1);
}
