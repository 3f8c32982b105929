#include <eunoe/core/deal_ii_message.h>
#include <eunoe/core/quoted_text.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <sstream>

namespace eunoe {

std::string deal_ii_message(const std::exception &error)
{
  // It may quote the input.
  constexpr std::size_t longest = 300;
  const auto *const exception = dynamic_cast<const dealii::ExceptionBase *>(&error);
  if (exception == nullptr)
    return shortened(error.what(), longest);
  std::ostringstream text;
  exception->print_info(text);
  std::string line = text.str();
  std::replace(line.begin(), line.end(), '\n', ' ');
  const std::size_t begin = line.find_first_not_of(' ');
  return begin == std::string::npos ? "unknown reason" : shortened(line.substr(begin), longest);
}

} // namespace eunoe
