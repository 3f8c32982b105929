#ifndef eunoe_core_declare_h
#define eunoe_core_declare_h

// How a part of the program declares its entries. Whoever declares needs no header of deal.II,
// which takes several seconds to compile.

#include <eunoe/core/vec3.h>

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace dealii {
class ParameterHandler;
}

namespace eunoe::declare {

void enter(dealii::ParameterHandler &prm, const std::string &subsection);
void leave(dealii::ParameterHandler &prm);

/// An entry that is written to @p value, whose present value is the default.
/// @tparam Value bool, int, unsigned int, unsigned long long, double, std::string, and
/// std::vector<std::string>, separated by commas
template <typename Value>
void entry(dealii::ParameterHandler &prm, const std::string &name, Value &value,
           const std::string &documentation);

/// A file that the run reads. Its contents count as the input does (`entries_naming_files`).
void file(dealii::ParameterHandler &prm, const std::string &name, std::string &value,
          const std::string &documentation);
/// Such files, separated by commas.
void files(dealii::ParameterHandler &prm, const std::string &name, std::vector<std::string> &values,
           const std::string &documentation);

/// A number within limits.
void between(dealii::ParameterHandler &prm, const std::string &name, double &value, double smallest,
             double largest, const std::string &documentation);
/// @tparam Number int, unsigned int, unsigned long, unsigned long long
template <typename Number>
void between(dealii::ParameterHandler &prm, const std::string &name, Number &value, int smallest,
             int largest, const std::string &documentation);

/// A number within limits, or a word.
/// @param at_first the default, as text
/// @param take gets the number, nothing for the word
void number_or_word(dealii::ParameterHandler &prm, const std::string &name, const std::string &word,
                    const std::string &at_first, double smallest, double largest,
                    const std::string &documentation,
                    const std::function<void(const std::optional<double> &)> &take);

/// A number that is at least @p smallest.
inline void at_least(dealii::ParameterHandler &prm, const std::string &name, double &value,
                     double smallest, const std::string &documentation)
{
  between(prm, name, value, smallest, std::numeric_limits<double>::max(), documentation);
}

/// A number that is not negative.
inline void not_negative(dealii::ParameterHandler &prm, const std::string &name, double &value,
                         const std::string &documentation)
{
  at_least(prm, name, value, 0., documentation);
}

/// A whole number that is not below @p smallest.
template <typename Number>
void count(dealii::ParameterHandler &prm, const std::string &name, Number &value,
           const std::string &documentation, const int smallest = 0)
{
  between(prm, name, value, smallest, std::numeric_limits<int>::max(), documentation);
}

/// How many subsections of a kind there are. This is read before all others, as it decides what
/// there is to be declared.
void number_of(dealii::ParameterHandler &prm, const std::string &name, std::size_t number,
               int smallest, int largest, const std::string &documentation);

/// How many numbers a list has, and what each may be.
struct ListLimits
{
  unsigned int shortest = 0, longest = std::numeric_limits<unsigned int>::max();
  double smallest = std::numeric_limits<double>::lowest(),
         largest = std::numeric_limits<double>::max();
};

/// Numbers separated by commas.
/// @tparam Number double, int, unsigned int
template <typename Number>
void list(dealii::ParameterHandler &prm, const std::string &name, std::vector<Number> &values,
          const ListLimits &limits, const std::string &documentation);

/// Texts separated by @p separator; an empty text is an empty list.
void list(dealii::ParameterHandler &prm, const std::string &name, std::vector<std::string> &values,
          char separator, const std::string &documentation);

/// Three numbers separated by commas.
void vector(dealii::ParameterHandler &prm, const std::string &name, Vec3 &value,
            const std::string &documentation);

/// Two corners of a box, "x, y, z : x, y, z".
void corners(dealii::ParameterHandler &prm, const std::string &name, Vec3 &first, Vec3 &second,
             const std::string &documentation);

/// One of several words, "a|b|c".
void choice(dealii::ParameterHandler &prm, const std::string &name, std::string &value,
            const std::string &choices, const std::string &documentation);

/// Another name by which an entry may be written.
void alias(dealii::ParameterHandler &prm, const std::string &name, const std::string &other);

} // namespace eunoe::declare

#endif
