#include <eunoe/core/input_file.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/discovery/measured_csv.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace eunoe::discovery {

namespace {

const std::vector<std::string> columns = {"experiment", "observable", "index", "value",
                                          "std",        "repeats",    "use"};
const std::string heading = boost::join(columns, ",");

/// Reads the table line by line.
class Reader
{
public:
  Reader(const std::string &file, const std::vector<Experiment> &experiments, Problems &problems)
      : file(file), experiments(experiments), problems(problems)
  {
  }

  MeasuredData read(const std::string &text)
  {
    std::istringstream stream(text);
    bool has_heading = false;
    for (std::string line; std::getline(stream, line);) {
      if (++number == 1 && boost::starts_with(line, byte_order_mark))
        line.erase(0, byte_order_mark.size());
      boost::trim(line);
      if (line.empty())
        continue;
      if (!is_utf8(line))
        complain("is not written in UTF-8.", "Save the file in that encoding, or keep to ASCII.");
      else if (line.front() == '#')
        read_header(line.substr(1));
      else if (has_heading)
        read_row(line);
      else if (!(has_heading = boost::erase_all_copy(line, " ") == heading)) {
        complain("is '" + line.substr(0, 60) + "' where the names of the columns should be.",
                 "Write '" + heading + "'.");
        return data;
      }
    }
    number = 0;
    if (!has_heading)
      complain("has no table.", "Begin it with '" + heading + "'.");
    else if (data.fit.empty() && problems.empty())
      complain("has no row whose use is 'fit'.", "Give what was measured.");
    check_units();
    return data;
  }

private:
  void complain(const std::string &what, const std::string &mend)
  {
    problems.add(file + (number > 0 ? ":" + std::to_string(number) : "") + ":", what, mend);
  }

  void read_header(const std::string &line)
  {
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos)
      data.header[boost::trim_copy(line.substr(0, colon))] =
          boost::trim_copy(line.substr(colon + 1));
  }

  /// A finite number, else a complaint.
  bool read_number(const std::string &word, const std::string &column, double &value)
  {
    char *end;
    value = std::strtod(word.c_str(), &end);
    const bool ok = !word.empty() && *end == '\0' && std::isfinite(value);
    if (!ok)
      complain("the " + column + " is '" + word.substr(0, 40) + "', which is no finite number.",
               "Give a number like 1.5e-3.");
    return ok;
  }

  bool read_count(const std::string &word, const std::string &column, const int smallest,
                  int &value)
  {
    char *end;
    const long number_read = std::strtol(word.c_str(), &end, 10);
    const bool ok =
        !word.empty() && *end == '\0' && number_read >= smallest && number_read <= 1000000;
    value = static_cast<int>(ok ? number_read : 0);
    if (!ok)
      complain("the " + column + " is '" + word.substr(0, 40) + "'.",
               "Give a whole number of at least " + std::to_string(smallest) + ".");
    return ok;
  }

  std::string suggestion(const std::string &word, const std::vector<std::string> &names) const
  {
    const std::string near = nearest_name(word, names);
    return near.empty() ? "There are: " + boost::join(names, ", ") + "."
                        : "Did you mean '" + near + "'?";
  }

  /// The experiment of a row, null after a complaint.
  const Experiment *find_experiment(const std::string &name)
  {
    std::vector<std::string> names;
    for (const Experiment &e : experiments) {
      if (e.name() == name)
        return &e;
      names.push_back(e.name());
    }
    complain("the experiment '" + name + "' is not in the study.", suggestion(name, names));
    return nullptr;
  }

  void check_observable(const Experiment &experiment, const std::string &name)
  {
    std::vector<std::string> names;
    for (const ObservableDescription &o : experiment.observables())
      names.push_back(o.name);
    if (std::find(names.begin(), names.end(), name) == names.end())
      complain("the observable '" + name + "' is not measured by experiment '" + experiment.name() +
                   "'.",
               suggestion(name, names));
  }

  void check_use(const Experiment &experiment, const std::string &use)
  {
    if (use != "fit" && use != "held-out")
      complain("the use is '" + use + "'.", "Give 'fit' or 'held-out'.");
    else if ((use == "held-out") != experiment.is_held_out())
      complain("the use is '" + use + "', and experiment '" + experiment.name() + "' is " +
                   (experiment.is_held_out() ? "" : "not ") + "held out in the study.",
               "Held-out data are a condition of their own: change 'held out' of the experiment, "
               "or the row.");
  }

  void read_row(const std::string &line)
  {
    std::vector<std::string> words;
    boost::split(words, line, [](const char c) { return c == ','; });
    for (std::string &word : words)
      boost::trim(word);
    if (words.size() != columns.size()) {
      complain("there are " + std::to_string(words.size()) + " values under " +
                   std::to_string(columns.size()) + " columns.",
               "Give one value a column: " + heading + ".");
      return;
    }
    const auto at = [&words](const std::string &column) -> const std::string & {
      return words[std::find(columns.begin(), columns.end(), column) - columns.begin()];
    };
    MeasuredPoint row;
    row.point.experiment = at("experiment");
    row.point.observable = at("observable");
    int repeats = 0;
    bool ok = read_count(at("index"), "index", 0, row.point.index);
    ok &= read_number(at("value"), "value", row.value);
    if (read_number(at("std"), "std", row.standard_deviation) && row.standard_deviation <= 0.)
      complain("the std is " + at("std") + ".",
               "Give a positive standard deviation of a single repeat.");
    ok &= read_count(at("repeats"), "repeats", 1, repeats);
    row.repeats = static_cast<unsigned int>(repeats);
    const Experiment *const experiment = find_experiment(at("experiment"));
    if (experiment == nullptr || !ok)
      return;
    check_observable(*experiment, at("observable"));
    check_use(*experiment, at("use"));
    const auto [earlier, is_new] = lines.emplace(row.point, number);
    if (!is_new)
      complain("the cell was given in line " + std::to_string(earlier->second) + " already.",
               "Remove one of the rows.");
    (at("use") == "fit" ? data.fit : data.held_out).push_back(row);
  }

  void check_units()
  {
    for (const Experiment &e : experiments)
      for (const ObservableDescription &o : e.observables()) {
        const auto said = data.header.find(unit_key(o.name));
        if (said != data.header.end() && said->second != o.unit)
          complain("the unit of '" + o.name + "' is said to be '" + said->second +
                       "', and the program's is '" + o.unit + "'.",
                   "Convert the values.");
      }
  }

  const std::string file;
  const std::vector<Experiment> &experiments;
  Problems &problems;
  MeasuredData data;
  std::map<DataPoint, unsigned int> lines;
  unsigned int number = 0;
};

} // namespace

MeasuredData read_measured(const std::string &text, const std::string &file,
                           const std::vector<Experiment> &experiments, Problems &problems)
{
  return Reader(file, experiments, problems).read(text);
}

std::string write_measured(const MeasuredData &data)
{
  std::string text;
  for (const auto &[key, value] : data.header)
    text += "# " + key + ": " + value + "\n";
  text += heading + "\n";
  for (const auto &[use, list] : {std::pair("fit", &data.fit), {"held-out", &data.held_out}})
    for (const MeasuredPoint &row : *list) {
      char numbers[96];
      std::snprintf(numbers, sizeof numbers, ",%d,%.17g,%.17g,%u,", row.point.index, row.value,
                    row.standard_deviation, row.repeats);
      text += row.point.experiment + "," + row.point.observable + numbers + use + "\n";
    }
  return text;
}

void check_data_points(const MeasuredData &data,
                       const std::map<std::string, std::vector<DataPoint>> &points,
                       const std::string &file, Problems &problems)
{
  for (const auto *list : {&data.fit, &data.held_out})
    for (const MeasuredPoint &row : *list) {
      const std::vector<DataPoint> &known = points.at(row.point.experiment);
      if (std::find(known.begin(), known.end(), row.point) != known.end())
        continue;
      std::string indices;
      for (const DataPoint &point : known)
        if (point.observable == row.point.observable)
          indices += (indices.empty() ? "" : ", ") + std::to_string(point.index);
      problems.add(file + ":",
                   "index " + std::to_string(row.point.index) + " of '" + row.point.observable +
                       "' is not measured by experiment '" + row.point.experiment + "'.",
                   indices.empty() ? "The base model does not give this observable at all."
                                   : "The base model gives the indices " + indices + ".");
    }
}

} // namespace eunoe::discovery
