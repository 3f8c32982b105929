#ifndef eunoe_core_declare_h
#define eunoe_core_declare_h

// Helpers for declaring parameters; for source files only, as it includes deal.II.

#include <eunoe/core/vec3.h>

#include <deal.II/base/parameter_handler.h>

namespace eunoe::declare {

namespace Patterns = dealii::Patterns;

/// Three numbers separated by commas.
inline void vector(dealii::ParameterHandler &prm, const std::string &entry, Vec3 &value,
                   const std::string &documentation)
{
  const auto text = [](double v) { return dealii::Patterns::Tools::to_string(v); };
  prm.declare_entry(entry, text(value.x) + ", " + text(value.y) + ", " + text(value.z),
                    Patterns::List(Patterns::Double(), 3, 3), documentation);
  prm.add_action(entry, [&value](const std::string &written) {
    const auto numbers =
        dealii::Utilities::string_to_double(dealii::Utilities::split_string_list(written));
    value = {numbers[0], numbers[1], numbers[2]};
  });
}

/// Two corners of a box, "x, y, z : x, y, z".
inline void corners(dealii::ParameterHandler &prm, const std::string &entry, Vec3 &first,
                    Vec3 &second, const std::string &documentation)
{
  const auto text = [](const Vec3 &v) {
    return dealii::Patterns::Tools::to_string(v.x) + ", " +
           dealii::Patterns::Tools::to_string(v.y) + ", " + dealii::Patterns::Tools::to_string(v.z);
  };
  prm.declare_entry(entry, text(first) + " : " + text(second),
                    Patterns::List(Patterns::List(Patterns::Double(), 3, 3), 2, 2, ":"),
                    documentation);
  prm.add_action(entry, [&first, &second](const std::string &written) {
    const auto points = dealii::Utilities::split_string_list(written, ':');
    Vec3 *const targets[2] = {&first, &second};
    for (unsigned int p = 0; p < 2; ++p) {
      const auto numbers =
          dealii::Utilities::string_to_double(dealii::Utilities::split_string_list(points[p]));
      *targets[p] = {numbers[0], numbers[1], numbers[2]};
    }
  });
}

/// One of several words, "a|b|c".
inline void choice(dealii::ParameterHandler &prm, const std::string &entry, std::string &value,
                   const std::string &choices, const std::string &documentation)
{
  prm.add_parameter(entry, value, documentation, Patterns::Selection(choices));
}

/// A number that is not negative.
inline void not_negative(dealii::ParameterHandler &prm, const std::string &entry, double &value,
                         const std::string &documentation)
{
  prm.add_parameter(entry, value, documentation, Patterns::Double(0.));
}

/// A whole number that is not below @p smallest.
template <typename Number>
void count(dealii::ParameterHandler &prm, const std::string &entry, Number &value,
           const std::string &documentation, const int smallest = 0)
{
  prm.add_parameter(entry, value, documentation, Patterns::Integer(smallest));
}

} // namespace eunoe::declare

#endif
