#include <eunoe/checkpoint/input_differences.h>
#include <eunoe/core/input_file.h>
#include <eunoe/core/quoted_text.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cstdlib>

namespace eunoe {

namespace {

using Path = std::vector<std::string>;
/// Whether an entry may differ: it changes no particle's path.
bool is_harmless(const Path &path, const std::string &entry)
{
  if (path == Path{"simulation control"})
    return entry != "time step" && entry != "time step share";
  if (path.size() >= 2 && path[0] == "model parameters" && path[1] == "load balancing")
    return true;
  if (path == Path{"model parameters"})
    return entry == "lost particles" || entry == "largest overlap" || entry == "excessive overlap";
  if (!path.empty() && path.back().compare(0, 12, "solid object") == 0)
    return entry == "output solid object";
  return !path.empty() && (path.front() == "restart" || path.front() == "post-processing" ||
                           path.front() == "boundary forces");
}

/// Whether two values are the same text or the same numbers.
bool are_equal(const std::string &a, const std::string &b)
{
  if (a == b)
    return true;
  std::vector<std::string> words_a, words_b;
  boost::split(words_a, a, boost::is_any_of(" ,:;"), boost::token_compress_on);
  boost::split(words_b, b, boost::is_any_of(" ,:;"), boost::token_compress_on);
  return std::equal(words_a.begin(), words_a.end(), words_b.begin(), words_b.end(),
                    [](const std::string &x, const std::string &y) {
                      char *end_x, *end_y;
                      const double u = std::strtod(x.c_str(), &end_x);
                      const double v = std::strtod(y.c_str(), &end_y);
                      const bool numbers =
                          !x.empty() && !y.empty() && *end_x == '\0' && *end_y == '\0';
                      return x == y || (numbers && u == v);
                    });
}

/// Notes what differs in an entry, unless it may.
void note(const std::pair<Path, std::string> &place, const std::string &what, Problems &problems)
{
  if (!is_harmless(place.first, place.second))
    problems.add(describe(place.first, place.second), what,
                 "Set it back, or start anew with 'restart = false' in subsection 'restart'.");
}

} // namespace

void find_input_differences(const EntryValues &now, const EntryValues &then,
                            const EntryValues &changed, const std::string &checkpoint,
                            Problems &problems)
{
  for (const auto &[place, value] : now) {
    const auto before = then.find(place);
    if (before == then.end()) {
      if (changed.count(place) > 0)
        note(place, "is set, and was not known in the run that wrote " + checkpoint + ".",
             problems);
    } else if (!are_equal(value, before->second))
      note(place,
           "is '" + shortened(value) + "', and was '" + shortened(before->second) +
               "' in the run that wrote " + checkpoint + ".",
           problems);
  }
  for (const auto &[place, value] : then)
    if (now.count(place) == 0)
      note(place, "is missing, and was '" + value + "' in the run that wrote " + checkpoint + ".",
           problems);
}

void find_file_differences(const EntryValues &now, const EntryValues &then,
                           const std::string &checkpoint, Problems &problems)
{
  for (const auto &[place, digest] : now)
    if (const auto before = then.find(place); before != then.end() && before->second != digest)
      note(place, "names a file that had other contents in the run that wrote " + checkpoint + ".",
           problems);
}

} // namespace eunoe
