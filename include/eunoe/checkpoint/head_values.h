#ifndef eunoe_checkpoint_head_values_h
#define eunoe_checkpoint_head_values_h

#include <eunoe/core/exact_sum.h>

#include <nlohmann/json.hpp>

#include <limits>
#include <stdexcept>

namespace eunoe {

// Values in the head of a checkpoint. JSON's own conversions take any number for any other, so a
// damaged one would be undefined behaviour; these throw a std::invalid_argument instead.

/// A whole number that is not negative and fits.
template <typename Number = std::uint64_t>
Number count_in(const nlohmann::ordered_json &json)
{
  if (!json.is_number_unsigned() ||
      json.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<Number>::max()))
    throw std::invalid_argument("this is no count");
  return static_cast<Number>(json.get<std::uint64_t>());
}

/// A finite number (JSON knows no other).
inline double number_in(const nlohmann::ordered_json &json)
{
  if (!json.is_number())
    throw std::invalid_argument("this is no number");
  return json.get<double>();
}

/// An exact sum, from its words.
inline ExactSum exact_sum_in(const nlohmann::ordered_json &json)
{
  std::vector<std::int64_t> words;
  for (const auto &word : json) {
    if (!word.is_number_integer())
      throw std::invalid_argument("this is no word");
    words.push_back(word.get<std::int64_t>());
  }
  return ExactSum::from_words(words);
}

} // namespace eunoe

#endif
