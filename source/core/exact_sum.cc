#include <eunoe/core/exact_sum.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace eunoe {

namespace {
constexpr std::int64_t base = std::int64_t(1) << 32;
constexpr std::uint32_t carry_after = 1u << 30;
} // namespace

ExactSum &ExactSum::operator+=(const double term)
{
  if (!std::isfinite(term)) {
    finite = false;
    return *this;
  }
  std::uint64_t bits;
  std::memcpy(&bits, &term, sizeof bits);
  const auto exponent = static_cast<unsigned int>((bits >> 52) & 0x7ff);
  std::uint64_t mantissa = bits & ((std::uint64_t(1) << 52) - 1);
  unsigned int place = 0;
  if (exponent > 0) {
    mantissa |= std::uint64_t(1) << 52;
    place = exponent - 1;
  }
  const unsigned int digit = place / 32, shift = place % 32;
  const std::uint64_t low = mantissa << shift;
  const std::uint64_t high = shift == 0 ? 0 : mantissa >> (64 - shift);
  const auto d0 = static_cast<std::int64_t>(low & 0xffffffffu);
  const auto d1 = static_cast<std::int64_t>(low >> 32);
  const auto d2 = static_cast<std::int64_t>(high);
  if (bits >> 63) {
    digits[digit] -= d0;
    digits[digit + 1] -= d1;
    digits[digit + 2] -= d2;
  } else {
    digits[digit] += d0;
    digits[digit + 1] += d1;
    digits[digit + 2] += d2;
  }
  if (++pending >= carry_after)
    carry();
  return *this;
}

void ExactSum::carry() const
{
  for (unsigned int d = 0; d + 1 < n_digits; ++d) {
    std::int64_t over = digits[d] / base;
    if (digits[d] - over * base < 0)
      --over;
    digits[d] -= over * base;
    digits[d + 1] += over;
  }
  pending = 0;
}

std::vector<std::int64_t> ExactSum::words() const
{
  carry();
  // Whether it is finite, the first digit that is not zero, and the digits from there on.
  unsigned int first = 0, last = n_digits;
  while (first < n_digits && digits[first] == 0)
    ++first;
  while (last > first && digits[last - 1] == 0)
    --last;
  std::vector<std::int64_t> list = {finite ? 1 : 0, first};
  list.insert(list.end(), digits.begin() + first, digits.begin() + last);
  return list;
}

ExactSum ExactSum::from_words(const std::vector<std::int64_t> &words)
{
  ExactSum sum;
  if (words.size() < 2 || words[1] < 0 || words[1] + words.size() - 2 > n_digits)
    throw std::invalid_argument("these are no words of an exact sum");
  const auto is_digit = [](std::int64_t word) { return word >= 0 && word < base; };
  // Only the highest digit has a sign, and it stays far from its limits.
  const bool has_top = words[1] + words.size() - 2 == n_digits && words.size() > 2;
  if (!std::all_of(words.begin() + 2, words.end() - (has_top ? 1 : 0), is_digit) ||
      (has_top && !is_digit(words.back()) && !is_digit(-(words.back() + 1))))
    throw std::invalid_argument("these are no words of an exact sum");
  sum.finite = words[0] != 0;
  std::copy(words.begin() + 2, words.end(), sum.digits.begin() + words[1]);
  return sum;
}

ExactSum &ExactSum::operator+=(const ExactSum &other)
{
  carry();
  other.carry();
  for (unsigned int d = 0; d < n_digits; ++d)
    digits[d] += other.digits[d];
  finite = finite && other.finite;
  carry();
  return *this;
}

ExactSum &ExactSum::operator-=(const ExactSum &other)
{
  carry();
  other.carry();
  for (unsigned int d = 0; d < n_digits; ++d)
    digits[d] -= other.digits[d];
  finite = finite && other.finite;
  carry();
  return *this;
}

bool operator==(const ExactSum &a, const ExactSum &b)
{
  a.carry();
  b.carry();
  return a.finite && b.finite && a.digits == b.digits;
}

double ExactSum::value() const
{
  if (!finite)
    return std::numeric_limits<double>::quiet_NaN();
  ExactSum magnitude = *this;
  magnitude.carry();
  const bool negative = magnitude.digits[n_digits - 1] < 0;
  if (negative) {
    for (std::int64_t &digit : magnitude.digits)
      digit = -digit;
    magnitude.carry();
  }
  unsigned int top = n_digits - 1;
  while (top > 0 && magnitude.digits[top] == 0)
    --top;
  // Three digits hold at least 65 significant bits, more than a double can take.
  double value = 0.;
  for (unsigned int d = top < 2 ? 0 : top - 2; d <= top; ++d)
    value += std::ldexp(static_cast<double>(magnitude.digits[d]), 32 * static_cast<int>(d) - 1074);
  return negative ? -value : value;
}

void ExactSum::reduce(const std::vector<ExactSum *> &sums, MPI_Comm comm)
{
  constexpr std::size_t n = n_digits + 1;
  std::vector<std::int64_t> buffer;
  buffer.reserve(n * sums.size());
  for (ExactSum *const sum : sums) {
    sum->carry();
    buffer.insert(buffer.end(), sum->digits.begin(), sum->digits.end());
    buffer.push_back(sum->finite ? 0 : 1);
  }
  MPI_Allreduce(MPI_IN_PLACE, buffer.data(), static_cast<int>(buffer.size()), MPI_INT64_T, MPI_SUM,
                comm);
  auto from = buffer.begin();
  for (ExactSum *const sum : sums) {
    std::copy_n(from, n_digits, sum->digits.begin());
    sum->finite = from[n_digits] == 0;
    sum->carry();
    from += n;
  }
}

} // namespace eunoe
