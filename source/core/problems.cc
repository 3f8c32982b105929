#include <eunoe/core/problems.h>

namespace eunoe {

std::string Problems::text() const
{
  std::string text;
  for (const Problem &problem : list)
    text += (text.empty() ? "" : "\n") + problem.text();
  return text;
}

} // namespace eunoe
