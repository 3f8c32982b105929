#ifndef eunoe_contrib_fuzzing_input_mutator_h
#define eunoe_contrib_fuzzing_input_mutator_h

// How fuzzers of input files change an input: half of the time as libFuzzer does, which ignores
// lines, half of the time by giving an entry another value.

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t *data, std::size_t size, std::size_t max_size);

namespace fuzzing {

/// Values that a reader may stumble over.
inline const std::vector<std::string> &awkward_values()
{
  static const std::vector<std::string> list = {"",
                                                "0",
                                                "-1",
                                                "1",
                                                "2",
                                                "3",
                                                "0.5",
                                                "nan",
                                                "inf",
                                                "-inf",
                                                "1e308",
                                                "-1e308",
                                                "1e-308",
                                                "1e-320",
                                                "1e-9",
                                                "1e9",
                                                "1e15",
                                                "2147483647",
                                                "2147483648",
                                                "4294967295",
                                                "4294967296",
                                                "-2147483648",
                                                "9223372036854775807",
                                                "18446744073709551615",
                                                "true",
                                                "false",
                                                "none",
                                                "0, 0, 0",
                                                "1e300, 0, 0",
                                                "1e-300, 1e-300, 1e-300",
                                                ":",
                                                ",",
                                                ";",
                                                "a, b",
                                                "0; 0; 0",
                                                "t; 1/0; sqrt(-1)",
                                                "rand(); x; y",
                                                "\\",
                                                "#"};
  return list;
}

/// Gives an entry of the text another value, or one of the numbers in its value.
inline std::string with_other_value(const std::string &text, std::minstd_rand &draw)
{
  std::vector<std::size_t> places;
  for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at + 1))
    places.push_back(at + 1);
  if (places.empty())
    return text;
  const std::string &value = awkward_values()[draw() % awkward_values().size()];
  std::size_t begin = places[draw() % places.size()];
  std::size_t end = std::min(text.find('\n', begin), text.size());
  if (draw() % 2 == 0) {
    std::vector<std::size_t> cuts = {begin};
    for (std::size_t at = begin; at < end; ++at)
      if (std::strchr(",:;", text[at]) != nullptr)
        cuts.push_back(at + 1);
    begin = cuts[draw() % cuts.size()];
    end = std::min(text.find_first_of(",:;\n", begin), end);
  }
  return text.substr(0, begin) + " " + value + text.substr(end);
}

} // namespace fuzzing

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size,
                                               std::size_t max_size, unsigned int seed)
{
  std::minstd_rand draw(seed);
  if (draw() % 2 == 0)
    return LLVMFuzzerMutate(data, size, max_size);
  const std::string text = fuzzing::with_other_value(std::string(data, data + size), draw);
  const std::size_t length = std::min(text.size(), max_size);
  std::memcpy(data, text.data(), length);
  return length;
}

#endif
