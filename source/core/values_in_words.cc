// What a value should be and is not, in words for the user.

#include "values_in_words.h"

#include <eunoe/core/quoted_text.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <regex>

namespace eunoe {

namespace {

bool is_number(const std::string &text)
{
  char *end;
  std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

} // namespace

std::string in_words(const std::string &pattern)
{
  std::smatch part;
  if (pattern == "[Bool]")
    return "true or false";
  if (std::regex_match(pattern, part, std::regex(R"(\[Selection (.*?) ?\])"))) {
    const std::string words = std::regex_replace(part[1].str(), std::regex(R"(\|)"), "', '");
    return (words.find("', '") == std::string::npos ? "'" : "one of '") + words + "'";
  }
  if (std::regex_match(pattern, part,
                       std::regex(R"(\[List of <(.*)> of length (\d+)\.\.\.(\d+).*\])")))
  {
    const std::string items = in_words(part[1]);
    if (items.empty())
      return "";
    // Two points of three numbers each, as the corners of a box.
    const bool of_points = part[1].str().compare(0, 6, "[List ") == 0;
    if (of_points)
      return part[2].str() + " points, 'x, y, z : x, y, z'";
    const std::string number = part[2] == part[3] ? part[2].str() + " values" : "a list of values";
    return number + ", each " + items;
  }
  if (std::regex_match(pattern, part, std::regex(R"(\[(\w+) or (\[.*\])\])")))
    return in_words(part[2]) + ", or '" + part[1].str() + "'";
  const std::regex range(
      R"(\[(Double|Integer)(?: range)?(?: (\S+?)\.\.\.(\S+?) \(inclusive\))?\])");
  if (std::regex_match(pattern, part, range)) {
    std::string words = part[1] == "Double" ? "a number" : "a whole number";
    const auto is_bound = [](const std::string &text) {
      return !text.empty() && text.find("DOUBLE") == std::string::npos &&
             std::abs(std::strtod(text.c_str(), nullptr)) < 2147483647.;
    };
    if (is_bound(part[2]))
      words += " of at least " + part[2].str();
    if (is_bound(part[3]))
      words += (is_bound(part[2]) ? " and at most " : " of at most ") + part[3].str();
    return words;
  }
  return "";
}

std::string usual_mistake(const std::string &value, const std::string &wanted)
{
  const std::string lookalike = advice_on_lookalikes(value);
  if (!lookalike.empty())
    return lookalike;
  const bool one = wanted.compare(0, 8, "a number") == 0;
  const bool whole = wanted.compare(0, 14, "a whole number") == 0;
  if (!one && !whole)
    return "";
  const std::size_t comma = value.find(',');
  if (comma != std::string::npos && comma == value.rfind(',')) {
    std::string with_point = value;
    with_point[comma] = '.';
    if (value.size() < 40 && is_number(with_point))
      return "Decimals have a point: " + with_point + ".";
  }
  const std::size_t end = value.find_first_not_of("0123456789", value.find_first_of("+-") == 0);
  if (whole && end == std::string::npos)
    return "";
  if (whole && is_number(value))
    return "Write it in digits alone, without point or exponent.";
  if (one && is_number(value))
    return std::isfinite(std::strtod(value.c_str(), nullptr))
               ? ""
               : "It must be finite, and below 1.8e308 in size.";
  char *rest;
  std::strtod(value.c_str(), &rest);
  std::string unit = rest;
  unit.erase(0, unit.find_first_not_of(' '));
  if (rest != value.c_str() && unit.size() < 12 &&
      std::isalpha(static_cast<unsigned char>(unit[0])))
    return "Leave out '" + unit + "': numbers have no units and are in SI units.";
  return "";
}

std::string with_limit(const std::string &wanted, const std::string &value)
{
  constexpr int limit = std::numeric_limits<int>::max();
  if (wanted.compare(0, 14, "a whole number") != 0 || wanted.find("at most") != std::string::npos ||
      value.find_first_not_of("0123456789") != std::string::npos ||
      std::strtod(value.c_str(), nullptr) <= limit)
    return wanted;
  const std::string lower = " of at least ";
  const std::size_t place = wanted.find(lower);
  if (place == std::string::npos)
    return wanted + " of at most " + std::to_string(limit);
  return wanted.substr(0, place) + " from " + wanted.substr(place + lower.size()) + " to " +
         std::to_string(limit);
}

std::string wanted_by(std::string message)
{
  // By hand: a regular expression recurses once for each blank, and the value may have many.
  std::replace_if(
      message.begin(), message.end(), [](unsigned char c) { return std::isspace(c) != 0; }, ' ');
  message.erase(std::unique(message.begin(), message.end(),
                            [](char a, char b) { return a == ' ' && b == ' '; }),
                message.end());
  const std::size_t begin = message.find('<', message.rfind("given pattern"));
  const std::size_t end = message.find("]>.", begin);
  if (begin == std::string::npos || end == std::string::npos)
    return "";
  return in_words(message.substr(begin + 1, end - begin));
}

} // namespace eunoe
