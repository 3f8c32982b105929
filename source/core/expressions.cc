#include <eunoe/core/expressions.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/silent_errors.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/base/utilities.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <stdexcept>

namespace eunoe {

struct Expressions::Parser
{
  explicit Parser(unsigned int n) : function(n, 0., 1e-9) {}

  dealii::FunctionParser<3> function;
};

namespace {

std::map<std::string, double> values_of(const std::string &constants)
{
  std::map<std::string, double> values;
  for (const std::string &definition : dealii::Utilities::split_string_list(constants, ',')) {
    const auto parts = dealii::Utilities::split_string_list(definition, '=');
    char *end = nullptr;
    if (parts.size() == 2)
      values[parts[0]] = std::strtod(parts[1].c_str(), &end);
    if (parts.size() != 2 || parts[1].empty() || *end != '\0')
      throw std::invalid_argument("'" + shortened(definition) + "' is no constant 'name=value'");
  }
  values["pi"] = M_PI;
  return values;
}

} // namespace

Expressions::Expressions(const std::string &text, const std::string &constants,
                         const unsigned int n)
    : parser(std::make_unique<Parser>(n))
{
  const std::map<std::string, double> values = values_of(constants);
  const auto parts = dealii::Utilities::split_string_list(text, ';');
  if (parts.size() != n)
    throw std::invalid_argument("'" + shortened(text) + "' does not hold " +
                                (n == 1   ? "one expression"
                                 : n == 3 ? "three expressions"
                                          : std::to_string(n) + " expressions"));
  bool understood = true;
  {
    const SilentErrors silence; // the sentence that is thrown here is enough
    try {
      parser->function.initialize("x,y,z,t", parts, values, true);
      for (unsigned int k = 0; k < n; ++k)
        value(k, {}, 0.);
    } catch (const std::exception &) {
      understood = false;
    }
  }
  if (!understood)
    throw std::invalid_argument("'" + shortened(text) + "' is not understood");
}

Expressions::~Expressions() = default;

double Expressions::value(const unsigned int k, const Vec3 &x, const double t) const
{
  parser->function.set_time(t);
  return parser->function.value(dealii::Point<3>(x.x, x.y, x.z), k);
}

} // namespace eunoe
