#include "deal_ii_message.h"

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <sstream>

namespace eunoe {

std::string deal_ii_message(const std::exception &error)
{
  const auto *const exception = dynamic_cast<const dealii::ExceptionBase *>(&error);
  if (exception == nullptr)
    return error.what();
  std::ostringstream text;
  exception->print_info(text);
  std::string line = text.str();
  std::replace(line.begin(), line.end(), '\n', ' ');
  const std::size_t begin = line.find_first_not_of(' ');
  return begin == std::string::npos ? "unknown reason" : line.substr(begin);
}

} // namespace eunoe
