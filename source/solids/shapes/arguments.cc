#include <eunoe/core/quoted_text.h>
#include <eunoe/solids/shapes.h>

#include <boost/algorithm/string.hpp>

#include <cstdlib>
#include <stdexcept>

namespace eunoe {

ShapeRegistry &named_shapes()
{
  static ShapeRegistry registry("shape");
  return registry;
}

ShapeArguments::ShapeArguments(const std::string &text)
{
  std::vector<std::string> parts;
  boost::split(parts, text, boost::is_any_of(":"));
  for (const std::string &part : parts) {
    std::vector<std::string> cells;
    boost::split(cells, part, boost::is_any_of(","));
    groups.emplace_back();
    for (std::string &cell : cells) {
      boost::trim(cell);
      char *end;
      groups.back().push_back(std::strtod(cell.c_str(), &end));
      if (cell.empty() || *end != '\0')
        throw std::invalid_argument("'" + shortened(cell) + "' is not a number");
    }
  }
}

const std::vector<double> &ShapeArguments::next(const std::size_t n_values)
{
  if (taken == groups.size())
    throw std::invalid_argument("there are too few arguments");
  if (groups[taken].size() != n_values)
    throw std::invalid_argument("argument " + std::to_string(taken + 1) + " has " +
                                std::to_string(groups[taken].size()) + " values instead of " +
                                std::to_string(n_values));
  return groups[taken++];
}

Vec3 ShapeArguments::vector()
{
  const auto &v = next(3);
  return {v[0], v[1], v[2]};
}

double ShapeArguments::number()
{
  return next(1)[0];
}

unsigned int ShapeArguments::count()
{
  const double value = number();
  if (!(value >= 1. && value == std::floor(value)))
    throw std::invalid_argument("argument " + std::to_string(taken) +
                                " is no positive whole number");
  if (value > 1e5)
    throw std::invalid_argument("argument " + std::to_string(taken) + " is more than 100000");
  return static_cast<unsigned int>(value);
}

void ShapeArguments::finish() const
{
  if (taken < groups.size())
    throw std::invalid_argument("there are too many arguments");
}

} // namespace eunoe
