#include <eunoe/core/silent_errors.h>
#include <eunoe/discovery/catalogue.h>

#include <deal.II/base/function_parser.h>

#include <boost/algorithm/string.hpp>

#include <cmath>
#include <cstdlib>
#include <regex>
#include <stdexcept>

namespace eunoe::discovery {

namespace {

bool uses_base(const std::string &text)
{
  static const std::regex word(R"(\$\{[^}]*\bbase\b[^}]*\})");
  return std::regex_search(text, word);
}

double number_of(const std::string &base)
{
  char *end;
  const double value = std::strtod(base.c_str(), &end);
  if (base.empty() || *end != '\0')
    throw std::invalid_argument("needs a number as 'base', and the case has '" + base + "'");
  return value;
}

std::string evaluate(const std::string &expression, const double base, const double amplitude)
{
  double value = std::nan("");
  {
    const SilentErrors silence;
    try {
      dealii::FunctionParser<2> parser;
      parser.initialize("base,amplitude", expression, {{"pi", M_PI}});
      value = parser.value(dealii::Point<2>(base, amplitude));
    } catch (const std::exception &) {
      throw std::invalid_argument("has '${" + expression + "}', which is not understood");
    }
  }
  if (!std::isfinite(value))
    throw std::invalid_argument("has '${" + expression + "}', which is no number here");
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// Puts numbers in the places of all expressions.
std::string fill_in(const std::string &pattern, const std::string &base, const double amplitude)
{
  const double base_value = uses_base(pattern) ? number_of(base) : 0.;
  std::string filled;
  std::size_t at = 0;
  while (true) {
    const std::size_t open = pattern.find("${", at);
    filled += pattern.substr(at, open - at);
    if (open == std::string::npos)
      return filled;
    const std::size_t close = pattern.find('}', open);
    if (close == std::string::npos)
      throw std::invalid_argument("has a '${' without '}'");
    filled += evaluate(pattern.substr(open + 2, close - open - 2), base_value, amplitude);
    at = close + 1;
  }
}

/// Splits at commas that stand outside of expressions.
std::vector<std::string> elements(const std::string &text)
{
  std::vector<std::string> parts(1);
  bool inside = false;
  for (const char c : text) {
    inside = inside ? c != '}' : c == '{';
    if (c == ',' && !inside)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (std::string &part : parts)
    boost::trim(part);
  return parts;
}

} // namespace

std::string patched_value(const std::string &pattern, const std::string &base,
                          const double amplitude)
{
  if (!uses_base(pattern))
    return fill_in(pattern, "", amplitude);
  std::vector<std::string> patterns = elements(pattern);
  const std::vector<std::string> bases = elements(base);
  if (patterns.size() == 1)
    patterns.resize(bases.size(), patterns.front());
  if (patterns.size() != bases.size())
    throw std::invalid_argument("is a list of " + std::to_string(patterns.size()) +
                                " elements with 'base', and the case has '" + base + "'");
  for (std::size_t k = 0; k < patterns.size(); ++k)
    patterns[k] = fill_in(patterns[k], bases[k], amplitude);
  return boost::join(patterns, ", ");
}

void Effect::apply(const double amplitude, EntryValues &values,
                   std::vector<std::string> &overrides) const
{
  for (const InputEntry &entry : entries) {
    if (entry.name.empty())
      continue;
    const std::string place = entry.where + ": " + describe(entry.path, entry.name);
    const bool is_known = values.count({entry.path, entry.name}) > 0;
    if (uses_base(entry.value) && !is_known)
      throw UserError(place + " needs 'base', and the case has no such entry. Check its name.");
    std::string &value = values[{entry.path, entry.name}];
    try {
      value = patched_value(entry.value, value, amplitude);
    } catch (const std::invalid_argument &error) {
      throw UserError(place + " " + error.what() +
                      ". Use numbers, 'amplitude' and 'base' in '${...}'.");
    }
    overrides.push_back(boost::join(entry.path, "/") + (entry.path.empty() ? "" : "/") +
                        entry.name + " = " + value);
  }
}

} // namespace eunoe::discovery
