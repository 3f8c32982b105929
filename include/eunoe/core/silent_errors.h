#ifndef eunoe_core_silent_errors_h
#define eunoe_core_silent_errors_h

#include <iostream>
#include <sstream>

namespace eunoe {

/// Keeps the standard error stream silent while it lives: deal.II's parser of expressions prints
/// what it does not understand there before it throws.
class SilentErrors
{
public:
  SilentErrors() : stream(std::cerr.rdbuf(unwanted.rdbuf())) {}
  ~SilentErrors() { std::cerr.rdbuf(stream); }
  SilentErrors(const SilentErrors &) = delete;
  SilentErrors &operator=(const SilentErrors &) = delete;

private:
  std::ostringstream unwanted;
  std::streambuf *const stream;
};

} // namespace eunoe

#endif
