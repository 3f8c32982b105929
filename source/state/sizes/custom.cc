#include <eunoe/core/declare.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/quoted_text.h>

#include "tabulated.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace eunoe {
namespace {

/// Diameters (m) and the share of each.
struct SizeTable
{
  std::vector<double> diameters, shares;
};

/// Classes of equal diameters, with their shares of the number.
class Classes : public SizeDistribution
{
public:
  Classes(std::vector<double> diameters, std::vector<double> numbers)
      : diameters(std::move(diameters)), cumulative(std::move(numbers))
  {
    double sum = 0.;
    for (std::size_t c = 0; c < cumulative.size(); ++c) {
      const double d = this->diameters[c];
      cube += cumulative[c] * d * d * d;
      sum += cumulative[c];
      cumulative[c] = sum;
    }
    cube /= sum;
    for (double &share : cumulative)
      share /= sum;
  }

  double diameter(double u) const override
  {
    const auto it = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u);
    return diameters[it - cumulative.begin()];
  }
  double smallest() const override { return *std::min_element(diameters.begin(), diameters.end()); }
  double largest() const override { return *std::max_element(diameters.begin(), diameters.end()); }
  double mean_cube() const override { return cube; }

private:
  std::vector<double> diameters, cumulative;
  double cube = 0.;
};

/// For callers before the check of the parameters, or in spite of its result.
UserError cannot_be_made(const std::string &what)
{
  return UserError("A custom size distribution cannot be made: " + what);
}

/// A custom distribution's cut-offs (m).
std::pair<double, double> range_of(const SizeDistributionParameters &p)
{
  return {std::max(p.smallest, 0.),
          p.largest > 0. ? p.largest : std::numeric_limits<double>::infinity()};
}

std::unique_ptr<SizeDistribution> make_classes(const SizeDistributionParameters &p,
                                               const SizeTable &table)
{
  const auto [low, high] = range_of(p);
  std::vector<double> diameters, numbers;
  for (std::size_t c = 0; c < table.diameters.size(); ++c) {
    const double d = table.diameters[c];
    const double share = table.shares[c] * p.weight(d);
    // A class without particles is no size: tables of laser diffraction have them at both ends.
    if (d < low || d > high || share == 0.)
      continue;
    diameters.push_back(d);
    numbers.push_back(p.basis == "volume" ? share / (d * d * d) : share);
  }
  if (diameters.empty())
    throw cannot_be_made("the cut-offs leave no diameter.");
  return std::make_unique<Classes>(std::move(diameters), std::move(numbers));
}

/// Each share spread evenly over the diameters since the one before; the first lies at its own.
std::unique_ptr<SizeDistribution> make_spread(const SizeDistributionParameters &p,
                                              const SizeTable &table)
{
  constexpr unsigned int n_pieces = 200;
  const auto [low, high] = range_of(p);
  const auto number = [&](double share, double d) {
    return share * p.weight(d) / (p.basis == "volume" ? d * d * d : 1.);
  };
  std::vector<double> diameters, numbers;
  const double first = table.diameters.front();
  diameters.push_back(std::max(first, low));
  numbers.push_back(first >= low && first <= high ? number(table.shares.front(), first) : 0.);
  for (std::size_t c = 1; c < table.diameters.size(); ++c) {
    const double a = table.diameters[c - 1], b = table.diameters[c];
    const double from = std::max(a, low), to = std::min(b, high);
    // A step of a CDF: two rows of one diameter.
    if (a == b && a >= low && a <= high) {
      diameters.push_back(b);
      numbers.push_back(number(table.shares[c], b));
    }
    if (!(from < to))
      continue;
    const double piece = (to - from) / n_pieces, share = table.shares[c] * piece / (b - a);
    for (unsigned int k = 0; k < n_pieces; ++k) {
      diameters.push_back(k + 1 < n_pieces ? from + (k + 1) * piece : to);
      numbers.push_back(number(share, from + (k + 0.5) * piece));
    }
  }
  if (!(std::accumulate(numbers.begin(), numbers.end(), 0.) > 0.))
    throw cannot_be_made("the cut-offs leave no diameter.");
  return std::make_unique<Tabulated>(std::move(diameters), numbers);
}

const std::string give_rows =
    "Give rows of a diameter (m) and a probability, separated by ';', ',' or space.";

/// Rows of two numbers; lines of words before them are a header. Throws std::invalid_argument.
SizeTable parse_sizes(const std::string &text, const std::string &file)
{
  std::istringstream stream(text);
  SizeTable table;
  unsigned int number = 0;
  for (std::string line; std::getline(stream, line);) {
    if (++number == 1 && line.compare(0, byte_order_mark.size(), byte_order_mark) == 0)
      line.erase(0, byte_order_mark.size());
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ';' || c == ',' || c == '\r'; }, ' ');
    std::istringstream words(line);
    double diameter, share;
    std::string rest;
    if (line.find_first_not_of(" \t") == std::string::npos || line[0] == '#')
      continue;
    const bool is_row = static_cast<bool>(words >> diameter);
    if (is_row && words >> share && !(words >> rest)) {
      table.diameters.push_back(diameter);
      table.shares.push_back(share);
    } else if (is_row || !table.diameters.empty())
      throw std::invalid_argument("is " + shortened(file) + ", whose line " +
                                  std::to_string(number) +
                                  " is not a diameter and a probability. " + give_rows);
  }
  if (table.diameters.empty())
    throw std::invalid_argument("is " + shortened(file) + ", which has no row of numbers. " +
                                give_rows);
  return table;
}

/// Whether shares are 1, or 100 of percent, in all.
void check_sum(const SizeTable &table, const bool is_cdf, const ParameterCheck &check,
               const ParameterCheck::Path &path, const std::string &entry)
{
  const std::vector<double> &shares = table.shares;
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.);
  const auto is_about = [](const double a, const double b) { return std::abs(a - b) <= 0.01 * b; };
  std::string mend = is_cdf ? "Divide each share by the last one, or correct the one that is wrong."
                            : "Divide each share by their sum, or correct the one that is wrong.";
  if (is_about(sum, 100.))
    mend = "Shares are no percent: divide each of them by 100.";
  else if (!is_cdf && shares.size() > 1 && std::is_sorted(shares.begin(), shares.end()) &&
           (is_about(shares.back(), 1.) || is_about(shares.back(), 100.)))
  {
    const bool in_percent = shares.back() > 10.;
    mend = "They grow to " + std::string(in_percent ? "100" : "1") +
           " as a CDF does: set 'custom distribution probability function type = CDF'" +
           (in_percent ? " and divide each by 100." : ".");
  }
  check.require(std::abs(sum - 1.) <= 1e-5, path, entry,
                (is_cdf ? "ends at " : "sums to ") + format(sum) + ", not " +
                    (is_cdf ? "at 1." : "to 1."),
                mend);
}

/// The lists of the input, the first under both of its names.
std::vector<std::string> entries_of_lists()
{
  return {"custom distribution diameters values", "custom diameters",
          "custom distribution diameters probabilities"};
}

class Custom : public SizeDistributionSection
{
public:
  void declare(dealii::ParameterHandler &prm) override;
  void read_files(const FileLoader &load) override;
  std::vector<std::string> own_entries() const override;
  /// Files for Lethe often have an 'average diameter' beside their classes.
  std::vector<std::string> unread_entries() const override { return {"standard deviation"}; }
  void check(const SizeDistributionParameters &shared, const ParameterCheck &check,
             const ParameterCheck::Path &path) const override;
  std::unique_ptr<SizeDistribution> make(const SizeDistributionParameters &shared) const override;

private:
  /// Throws std::invalid_argument if there is no table of the file.
  SizeTable table() const;

  std::vector<double> diameters = {0.001, 0.0005};
  std::vector<double> fractions = {0.6, 0.4};
  bool from_file = false; ///< the two lists are in a file
  std::string file = "custom_distribution.txt";
  std::string function_type = "PDF"; ///< of each diameter, or "CDF": up to it
  bool interpolates = false;         ///< sizes between the listed ones
  std::optional<SizeTable> of_file;
  std::string failure = "has not been read."; ///< why there is no table of the file
};

void Custom::declare(dealii::ParameterHandler &prm)
{
  declare::list(prm, "custom distribution diameters values", diameters,
                {1, std::numeric_limits<unsigned int>::max(), 0.},
                "Diameters of the classes of a custom distribution (m).");
  declare::alias(prm, "custom distribution diameters values", "custom diameters");
  declare::list(prm, "custom distribution diameters probabilities", fractions,
                {1, std::numeric_limits<unsigned int>::max(), 0.},
                "Share of each class of a custom distribution, which sum to 1; of a CDF, the "
                "share up to each diameter.");
  declare::entry(prm, "custom distribution from file", from_file,
                 "Whether diameters and probabilities of a custom distribution are in a file.");
  declare::file(prm, "custom distribution filename", file,
                "The file: a row each, diameter (m) and probability, separated by ';', ',' or "
                "space.");
  declare::choice(prm, "custom distribution probability function type", function_type, "PDF|CDF",
                  "Whether probabilities are those of each diameter or of all up to it.");
  declare::entry(prm, "custom distribution interpolation", interpolates,
                 "Whether each share is spread evenly between its diameter and the one before, "
                 "instead of belonging to its diameter alone.");
}

std::vector<std::string> Custom::own_entries() const
{
  std::vector<std::string> names = entries_of_lists();
  names.insert(names.end(), {"custom distribution from file", "custom distribution filename",
                             "custom distribution probability function type",
                             "custom distribution interpolation"});
  return names;
}

void Custom::read_files(const FileLoader &load)
{
  of_file.reset();
  if (!from_file)
    return;
  try {
    of_file = parse_sizes(load(file), file);
  } catch (const std::invalid_argument &error) {
    failure = error.what();
  } catch (const UserError &error) {
    failure = "gives no sizes: " + std::string(error.what());
  }
}

SizeTable Custom::table() const
{
  if (from_file && !of_file)
    throw std::invalid_argument(failure);
  SizeTable result = from_file ? *of_file : SizeTable{diameters, fractions};
  // What a CDF gains at each diameter.
  if (function_type == "CDF")
    std::adjacent_difference(result.shares.begin(), result.shares.end(), result.shares.begin());
  return result;
}

std::unique_ptr<SizeDistribution> Custom::make(const SizeDistributionParameters &shared) const
{
  try {
    const SizeTable read = table();
    if (read.diameters.size() != read.shares.size())
      throw cannot_be_made("there are not as many probabilities as diameters.");
    return interpolates ? make_spread(shared, read) : make_classes(shared, read);
  } catch (const std::invalid_argument &error) {
    throw cannot_be_made("the file " + std::string(error.what()));
  }
}

void Custom::check(const SizeDistributionParameters &shared, const ParameterCheck &check,
                   const ParameterCheck::Path &path) const
{
  const std::string of_diameters =
      from_file ? "custom distribution filename" : "custom distribution diameters values";
  const std::string of_shares =
      from_file ? of_diameters : "custom distribution diameters probabilities";
  const std::string choice = "custom distribution from file";
  const std::vector<std::string> unread =
      from_file ? entries_of_lists() : std::vector<std::string>{"custom distribution filename"};
  for (const std::string &entry : unread)
    check.advise(!check.is_changed_beside(path, entry, choice), path, entry,
                 "has no effect, as '" + choice + "' is " + (from_file ? "true." : "false."),
                 "Remove the entry, or set that to " + std::string(from_file ? "false." : "true."));
  SizeTable read;
  try {
    read = table();
  } catch (const std::invalid_argument &error) {
    check.require(false, path, of_diameters, error.what(), "");
    return;
  }
  const std::size_t n = read.diameters.size();
  check.require(n == read.shares.size(), path, of_shares,
                "has " + std::to_string(read.shares.size()) + " values for " + std::to_string(n) +
                    " diameters.",
                "Give one share for each of '" + of_diameters + "'.");
  if (n != read.shares.size())
    return;
  for (const double diameter : read.diameters)
    check.require(diameter > 0. && std::isfinite(diameter), path, of_diameters,
                  "contains a diameter of " + format(diameter) + " m.", "Give positive diameters.");
  const bool is_ordered = std::is_sorted(read.diameters.begin(), read.diameters.end());
  check.require(is_ordered || (function_type == "PDF" && !interpolates), path, of_diameters,
                "is not in ascending order, as a CDF and interpolation need it.",
                "Sort the diameters, each with its probability.");
  const bool grows = std::all_of(read.shares.begin(), read.shares.end(),
                                 [](const double share) { return share >= 0.; });
  check.require(grows, path, of_shares,
                function_type == "CDF" ? "decreases, which no CDF does." : "has a negative value.",
                "Correct the value.");
  check_sum(read, function_type == "CDF", check, path, of_shares);
  const auto [low, high] = range_of(shared);
  double within = 0.;
  for (std::size_t c = 0; c < n; ++c) {
    const double from = interpolates && c > 0 ? read.diameters[c - 1] : read.diameters[c];
    if (from <= high && read.diameters[c] >= low)
      within += read.shares[c];
  }
  check.require(within > 0., path, "minimum diameter cutoff",
                "and the maximum leave no diameter of the custom distribution.",
                "Widen the cut-offs.");
}

const SizeDistributionRegistry::Registration registration(size_distributions(), "custom", [] {
  return std::make_unique<Custom>();
});

} // namespace
} // namespace eunoe
