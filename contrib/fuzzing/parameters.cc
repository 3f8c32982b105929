// Any text as an input file: read, checked, printed and read again.

#include "fuzzing.h"
#include "input_mutator.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  const std::string text(data, data + size);
  eunoe::Problems problems;
  const eunoe::Parameters parameters = fuzzing::read(text, problems);
  (void)problems.text();
  if (!problems.empty())
    return 0;
  eunoe::Problems problems_again;
  const auto again = eunoe::Parameters::read(parameters.as_input_file(), "", {}, problems_again,
                                             fuzzing::loader(text));
  if (!problems_again.empty() || again.as_input_file() != parameters.as_input_file()) {
    std::fprintf(stderr, "The printed input is not read as the same:\n%s\n%s\n",
                 problems_again.text().c_str(), parameters.as_input_file().c_str());
    std::abort();
  }
  return 0;
}
