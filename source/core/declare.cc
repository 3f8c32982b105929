#include <eunoe/core/declare.h>

#include <deal.II/base/parameter_handler.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <type_traits>

namespace eunoe::declare {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

namespace {

Vec3 three_numbers(const std::string &written)
{
  const auto numbers =
      dealii::Utilities::string_to_double(dealii::Utilities::split_string_list(written));
  return {numbers[0], numbers[1], numbers[2]};
}

std::string as_text(const Vec3 &v)
{
  using dealii::Patterns::Tools::to_string;
  return to_string(v.x) + ", " + to_string(v.y) + ", " + to_string(v.z);
}

/// A number, or a word.
class NumberOrWord : public Patterns::PatternBase
{
public:
  NumberOrWord(const std::string &word, const Patterns::Double &number) : word(word), number(number)
  {
  }

  bool match(const std::string &text) const override { return text == word || number.match(text); }
  std::string description(const OutputStyle style = Machine) const override
  {
    return "[" + word + " or " + number.description(style) + "]";
  }
  std::unique_ptr<PatternBase> clone() const override
  {
    return std::make_unique<NumberOrWord>(*this);
  }

private:
  const std::string word;
  const Patterns::Double number;
};

} // namespace

void enter(ParameterHandler &prm, const std::string &subsection)
{
  prm.enter_subsection(subsection);
}

void leave(ParameterHandler &prm)
{
  prm.leave_subsection();
}

template <typename Value>
void entry(ParameterHandler &prm, const std::string &name, Value &value,
           const std::string &documentation)
{
  prm.add_parameter(name, value, documentation);
}

template void entry(ParameterHandler &, const std::string &, bool &, const std::string &);
template void entry(ParameterHandler &, const std::string &, int &, const std::string &);
template void entry(ParameterHandler &, const std::string &, unsigned int &, const std::string &);
template void entry(ParameterHandler &, const std::string &, unsigned long long &,
                    const std::string &);
template void entry(ParameterHandler &, const std::string &, double &, const std::string &);
template void entry(ParameterHandler &, const std::string &, std::string &, const std::string &);
template void entry(ParameterHandler &, const std::string &, std::vector<std::string> &,
                    const std::string &);

void file(ParameterHandler &prm, const std::string &name, std::string &value,
          const std::string &documentation)
{
  prm.add_parameter(name, value, documentation, Patterns::FileName());
}

void files(ParameterHandler &prm, const std::string &name, std::vector<std::string> &values,
           const std::string &documentation)
{
  prm.add_parameter(name, values, documentation, Patterns::List(Patterns::FileName()));
}

void between(ParameterHandler &prm, const std::string &name, double &value, const double smallest,
             const double largest, const std::string &documentation)
{
  prm.add_parameter(name, value, documentation, Patterns::Double(smallest, largest));
}

void number_or_word(ParameterHandler &prm, const std::string &name, const std::string &word,
                    const std::string &at_first, const double smallest, const double largest,
                    const std::string &documentation,
                    const std::function<void(const std::optional<double> &)> &take)
{
  prm.declare_entry(name, at_first, NumberOrWord(word, Patterns::Double(smallest, largest)),
                    documentation);
  prm.add_action(name, [word, take](const std::string &value) {
    take(value == word ? std::nullopt
                       : std::make_optional(dealii::Utilities::string_to_double(value)));
  });
}

template <typename Number>
void between(ParameterHandler &prm, const std::string &name, Number &value, const int smallest,
             const int largest, const std::string &documentation)
{
  prm.add_parameter(name, value, documentation, Patterns::Integer(smallest, largest));
}

template void between(ParameterHandler &, const std::string &, int &, int, int,
                      const std::string &);
template void between(ParameterHandler &, const std::string &, unsigned int &, int, int,
                      const std::string &);
template void between(ParameterHandler &, const std::string &, unsigned long &, int, int,
                      const std::string &);
template void between(ParameterHandler &, const std::string &, unsigned long long &, int, int,
                      const std::string &);

void number_of(ParameterHandler &prm, const std::string &name, const std::size_t number,
               const int smallest, const int largest, const std::string &documentation)
{
  prm.declare_entry(name, std::to_string(number), Patterns::Integer(smallest, largest),
                    documentation);
}

template <typename Number>
void list(ParameterHandler &prm, const std::string &name, std::vector<Number> &values,
          const ListLimits &limits, const std::string &documentation)
{
  using Pattern =
      std::conditional_t<std::is_integral_v<Number>, Patterns::Integer, Patterns::Double>;
  using Limit = std::conditional_t<std::is_integral_v<Number>, int, double>;
  const auto limit = [](double v) {
    return static_cast<Limit>(std::clamp(v,
                                         static_cast<double>(std::numeric_limits<Limit>::lowest()),
                                         static_cast<double>(std::numeric_limits<Limit>::max())));
  };
  prm.add_parameter(name, values, documentation,
                    Patterns::List(Pattern(limit(limits.smallest), limit(limits.largest)),
                                   limits.shortest, limits.longest));
}

template void list(ParameterHandler &, const std::string &, std::vector<double> &,
                   const ListLimits &, const std::string &);
template void list(ParameterHandler &, const std::string &, std::vector<int> &, const ListLimits &,
                   const std::string &);
template void list(ParameterHandler &, const std::string &, std::vector<unsigned int> &,
                   const ListLimits &, const std::string &);

void list(ParameterHandler &prm, const std::string &name, std::vector<std::string> &values,
          const char separator, const std::string &documentation)
{
  prm.declare_entry(name, boost::join(values, separator + std::string(" ")), Patterns::Anything(),
                    documentation);
  prm.add_action(name, [&values, separator](const std::string &text) {
    values = dealii::Utilities::split_string_list(text, separator);
  });
}

void vector(ParameterHandler &prm, const std::string &name, Vec3 &value,
            const std::string &documentation)
{
  prm.declare_entry(name, as_text(value), Patterns::List(Patterns::Double(), 3, 3), documentation);
  prm.add_action(name, [&value](const std::string &written) { value = three_numbers(written); });
}

void corners(ParameterHandler &prm, const std::string &name, Vec3 &first, Vec3 &second,
             const std::string &documentation)
{
  prm.declare_entry(name, as_text(first) + " : " + as_text(second),
                    Patterns::List(Patterns::List(Patterns::Double(), 3, 3), 2, 2, ":"),
                    documentation);
  prm.add_action(name, [&first, &second](const std::string &written) {
    const auto points = dealii::Utilities::split_string_list(written, ':');
    first = three_numbers(points[0]);
    second = three_numbers(points[1]);
  });
}

void choice(ParameterHandler &prm, const std::string &name, std::string &value,
            const std::string &choices, const std::string &documentation)
{
  prm.add_parameter(name, value, documentation, Patterns::Selection(choices));
}

void alias(ParameterHandler &prm, const std::string &name, const std::string &other)
{
  prm.declare_alias(name, other);
}

} // namespace eunoe::declare
