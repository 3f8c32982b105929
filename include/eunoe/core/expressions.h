#ifndef eunoe_core_expressions_h
#define eunoe_core_expressions_h

#include <eunoe/core/vec3.h>

#include <memory>
#include <string>

namespace eunoe {

/// Formulas in x, y, z and t that a user has written, separated by ';'.
class Expressions
{
public:
  /// @param constants "a=1, b=2"; pi is known
  /// Throws std::invalid_argument, without a full stop, if the text is not understood or does not
  /// hold @p n formulas.
  Expressions(const std::string &text, const std::string &constants, unsigned int n);
  ~Expressions();

  double value(unsigned int k, const Vec3 &x, double t) const;
  /// The first three formulas.
  Vec3 vector(const Vec3 &x, double t) const
  {
    return {value(0, x, t), value(1, x, t), value(2, x, t)};
  }

private:
  struct Parser;
  std::unique_ptr<Parser> parser;
};

} // namespace eunoe

#endif
