#ifndef eunoe_source_core_values_in_words_h
#define eunoe_source_core_values_in_words_h

#include <string>

namespace eunoe {

/// In words, what a description of a pattern such as "[Integer range 0...10 (inclusive)]" asks for;
/// empty for one that is unknown here.
std::string in_words(const std::string &pattern);

/// In words, what an entry wants whose value deal.II refused with @p message.
std::string wanted_by(std::string message);

/// Explains a value that is not a number, or not of the wanted kind, if the mistake is a usual one;
/// empty otherwise.
/// @param wanted description of the wanted kind
std::string usual_mistake(const std::string &value, const std::string &wanted);

/// Names the limit of whole numbers, if it is what a value exceeds.
/// @param wanted in words
std::string with_limit(const std::string &wanted, const std::string &value);

} // namespace eunoe

#endif
