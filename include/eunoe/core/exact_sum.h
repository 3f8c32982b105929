#ifndef eunoe_core_exact_sum_h
#define eunoe_core_exact_sum_h

#include <array>
#include <cstdint>
#include <mpi.h>
#include <vector>

namespace eunoe {

/// A sum of doubles without any rounding, hence independent of the order of its terms and of their
/// distribution over ranks (a fixed-point accumulator over the whole range of doubles; Kulisch,
/// Computer Arithmetic and Validity, 2013). Rounded once, when its value is asked for.
class ExactSum
{
public:
  ExactSum &operator+=(double term);
  ExactSum &operator-=(double term) { return *this += -term; }
  ExactSum &operator+=(const ExactSum &other);
  ExactSum &operator-=(const ExactSum &other);

  /// The sum, rounded; not a number if a term was not finite.
  double value() const;

  /// Whether two sums are equal to the last bit of all their terms.
  friend bool operator==(const ExactSum &a, const ExactSum &b);
  friend bool operator!=(const ExactSum &a, const ExactSum &b) { return !(a == b); }

  /// @name The exact state as whole numbers, to be kept and put back
  ///@{
  std::vector<std::int64_t> words() const;
  static ExactSum from_words(const std::vector<std::int64_t> &words);
  ///@}

  /// Adds up the sums of all ranks; collective.
  void reduce(MPI_Comm comm) { reduce({this}, comm); }
  /// The same for several at once.
  static void reduce(const std::vector<ExactSum *> &sums, MPI_Comm comm);

private:
  /// The largest double has its highest bit at place 2097; two digits more hold carries.
  static constexpr unsigned int n_digits = 68;

  /// Carries every digit but the last into [0, 2^32).
  void carry() const;

  /// Digits of base 2^32 in units of the smallest denormal number, not yet carried.
  mutable std::array<std::int64_t, n_digits> digits = {};
  mutable std::uint32_t pending = 0;
  bool finite = true;
};

} // namespace eunoe

#endif
