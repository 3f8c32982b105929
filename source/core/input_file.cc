#include <eunoe/core/input_file.h>
#include <eunoe/core/quoted_text.h>

#include <boost/algorithm/string.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <sstream>

namespace eunoe {

namespace {

/// Number of single-letter changes between two words (Levenshtein).
std::size_t distance(const std::string &a, const std::string &b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

std::string trimmed_words(std::string text)
{
  std::replace(text.begin(), text.end(), '\t', ' ');
  std::vector<std::string> words;
  boost::split(words, boost::trim_copy(text), boost::is_space(), boost::token_compress_on);
  return boost::join(words, " ");
}

/// Reads "name = value"; false if it is no such thing.
bool parse_assignment(const std::string &text, InputEntry &entry)
{
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    return false;
  entry.name = trimmed_words(text.substr(0, equals));
  entry.value = boost::trim_copy(text.substr(equals + 1));
  return !entry.name.empty();
}

} // namespace

std::string describe(const std::vector<std::string> &path, const std::string &entry)
{
  std::string text;
  for (const std::string &name : path)
    text += "subsection '" + shortened(name) + "' / ";
  return entry.empty() ? text.substr(0, text.size() - std::min<std::size_t>(3, text.size()))
                       : text + "entry '" + shortened(entry) + "'";
}

std::string nearest_name(const std::string &word, const std::vector<std::string> &candidates)
{
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string &candidate : candidates) {
    // Of long words, the lengths alone tell.
    if (word.size() > candidate.size() + best_distance)
      continue;
    const std::size_t d = distance(word, candidate);
    if (d < best_distance) {
      best = candidate;
      best_distance = d;
    }
  }
  return best;
}

bool is_utf8(const std::string &text)
{
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception &) {
    return false;
  }
}

namespace {

const std::string not_utf8 = "this is not written in UTF-8.",
                  mend_encoding = "Save the file in that encoding, or keep to ASCII.";

/// Reads one file and those that it includes.
class InputParser
{
public:
  InputParser(Problems &problems, const FileLoader &load) : problems(problems), load(load) {}

  void parse(const std::string &text, const std::string &file)
  {
    const std::size_t outer_depth = open_at_start;
    open_at_start = path.size();
    if (text.find('\0') != std::string::npos) {
      const std::string start = text.substr(0, 2);
      if (start == "\xFF\xFE" || start == "\xFE\xFF")
        problems.add(file + ":", "this is written in UTF-16.",
                     "Save the file in UTF-8, or keep to ASCII.");
      else
        problems.add(file + ":", "this is no text.", "Give an input file.");
      return;
    }
    std::istringstream stream(text);
    if (text.compare(0, byte_order_mark.size(), byte_order_mark) == 0) {
      problems.warn(
          file + ":1:", "the file begins with a byte-order mark (U+FEFF), which is passed over.",
          "Save the file in UTF-8 without one.");
      stream.ignore(static_cast<std::streamsize>(byte_order_mark.size()));
    }
    std::string line;
    unsigned int number = 0;
    while (std::getline(stream, line)) {
      ++number;
      const std::string where = file + ":" + std::to_string(number);
      std::string statement = strip(line);
      while (!statement.empty() && statement.back() == '\\' && std::getline(stream, line)) {
        ++number;
        statement.pop_back();
        statement += strip(line);
      }
      boost::trim(statement);
      if (!is_utf8(statement))
        problems.add(where + ":", not_utf8, mend_encoding);
      else if (!statement.empty())
        understand(statement, file, where);
    }
    if (path.size() > open_at_start) {
      problems.add(file + ":",
                   "the " + describe(path, "") + " is still open at the end of the file.",
                   "Add the missing 'end'.");
      path.resize(open_at_start);
    }
    open_at_start = outer_depth;
  }

  std::vector<InputEntry> entries;

private:
  static std::string strip(const std::string &line)
  {
    return boost::trim_right_copy(line.substr(0, line.find('#')));
  }

  void understand(const std::string &statement, const std::string &file, const std::string &where)
  {
    const std::string word = statement.substr(0, statement.find_first_of(" \t"));
    const std::string rest = trimmed_words(statement.substr(word.size()));
    constexpr std::size_t deepest = 20;
    if (path.size() > deepest && word != "end")
      return;
    if (word == "subsection" && !rest.empty()) {
      if (path.size() == deepest)
        problems.add(where + ":", "more than " + std::to_string(deepest) + " subsections are open.",
                     "Add the missing 'end's.");
      path.push_back(rest);
      InputEntry opening;
      opening.path = path;
      opening.where = where;
      opening.is_default = true;
      entries.push_back(opening);
    } else if (word == "end" && rest.empty()) {
      if (path.size() == open_at_start)
        problems.add(where + ":", "there is an 'end' without a 'subsection' before it.",
                     "Remove it.");
      else
        path.pop_back();
    } else if (word == "include" && !rest.empty() && load)
      include(rest, file, where);
    else if (word == "set") {
      InputEntry entry;
      entry.path = path;
      entry.where = where;
      if (parse_assignment(statement.substr(word.size()), entry))
        entries.push_back(entry);
      else
        problems.add(where + ":", "'" + shortened(statement) + "' has no '='.",
                     "Write 'set entry = value'.");
    } else {
      const std::string advice = advice_on_lookalikes(statement);
      problems.add(where + ":", "'" + shortened(statement) + "' is not understood.",
                   !advice.empty()
                       ? advice
                       : "A line is 'set entry = value', 'subsection name', 'end', 'include "
                         "file', or a comment after '#'.");
    }
  }

  void include(const std::string &name, const std::string &file, const std::string &where)
  {
    constexpr unsigned int deepest = 10, most = 1000;
    if (depth == deepest || n_included == most) {
      // Said once: files that include each other twice would do so a million times.
      if (n_included < most)
        problems.add(where + ":", "files include each other without end.",
                     "Remove one of the includes.");
      n_included = most;
      return;
    }
    ++n_included;
    const auto folder = std::filesystem::path(file).parent_path();
    const std::string included = (folder / name).lexically_normal().string();
    ++depth;
    try {
      parse(load(included), included);
    } catch (const UserError &error) {
      problems.add(where + ":", error.what(), "");
    }
    --depth;
  }

  Problems &problems;
  const FileLoader &load;
  std::vector<std::string> path;
  std::size_t open_at_start = 0; ///< number of open subsections at the start of this file
  unsigned int depth = 0, n_included = 0;
};

} // namespace

std::vector<InputEntry> parse_input(const std::string &text, const std::string &file,
                                    Problems &problems, const FileLoader &load)
{
  InputParser parser(problems, load);
  parser.parse(text, file);
  return parser.entries;
}

EntryValues values_in(const std::string &text)
{
  Problems problems;
  EntryValues values;
  for (const InputEntry &entry : parse_input(text, "", problems))
    if (!entry.name.empty())
      values[{entry.path, entry.name}] = entry.value;
  return values;
}

InputEntry parse_override(const std::string &text, Problems &problems)
{
  InputEntry entry;
  entry.where = "--set \"" + shortened(text) + "\"";
  const std::size_t equals = text.find('=');
  if (!is_utf8(text)) {
    problems.add("--set:", not_utf8, mend_encoding);
    return entry;
  }
  if (!parse_assignment(text, entry)) {
    problems.add(entry.where + ":", "it has no '='.", "Write --set \"subsection/entry = value\".");
    return entry;
  }
  // In a file the first begins a comment, the second goes on in the next line: used.prm could not
  // hold the value.
  if (text.find('#') != std::string::npos || boost::ends_with(entry.value, "\\")) {
    problems.add(entry.where + ":", "a value has no '#' and does not end with '\\'.",
                 "Choose another value.");
    entry.name.clear();
    return entry;
  }
  std::vector<std::string> names;
  boost::split(names, text.substr(0, equals), boost::is_any_of("/"));
  for (std::string &name : names) {
    name = trimmed_words(name);
    if (boost::starts_with(name, "subsection "))
      name = name.substr(11);
  }
  if (std::any_of(names.begin(), names.end(), [](const std::string &n) { return n.empty(); })) {
    problems.add(entry.where + ":", "its path has an empty part, as 'a//b' has.",
                 "Write --set \"subsection/entry = value\".");
    entry.name.clear();
    return entry;
  }
  entry.name = names.back();
  names.pop_back();
  entry.path = names;
  return entry;
}

std::vector<InputEntry> parse_input_and_overrides(const std::string &text, const std::string &file,
                                                  const std::vector<std::string> &overrides,
                                                  Problems &problems, const FileLoader &load)
{
  std::vector<InputEntry> entries = parse_input(text, file, problems, load);
  for (const std::string &override_text : overrides) {
    const InputEntry entry = parse_override(override_text, problems);
    if (!entry.name.empty())
      entries.push_back(entry);
  }
  return entries;
}

} // namespace eunoe
