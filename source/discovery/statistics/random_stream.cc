#include <eunoe/core/random.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <cmath>

namespace eunoe::discovery {

double RandomStream::uniform()
{
  const unsigned int place = static_cast<unsigned int>(count % 2);
  if (place == 0) {
    const std::uint64_t number = count / 2;
    block = philox(
        {{static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), 0, 1}},
        key);
  }
  ++count;
  const std::uint64_t bits =
      (std::uint64_t(block[2 * place]) << 32 | block[2 * place + 1]) >> 11;
  return (static_cast<double>(bits) + 0.5) * 0x1p-53;
}

double RandomStream::normal()
{
  return normal_quantile(uniform());
}

std::size_t RandomStream::index(const std::size_t bound)
{
  return std::min(bound - 1, static_cast<std::size_t>(uniform() * static_cast<double>(bound)));
}

Eigen::MatrixXd RandomStream::normals(const Eigen::Index rows, const Eigen::Index columns)
{
  Eigen::MatrixXd result(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j)
      result(i, j) = normal();
  return result;
}

double normal_quantile(const double probability)
{
  // A rational start in the manner of Acklam, then one step of Halley's method on erfc.
  const double p = std::min(probability, 1. - probability);
  double x;
  if (p < 0.02425) {
    const double q = std::sqrt(-2. * std::log(p));
    x = (((((-7.784894002430293e-03 * q - 3.223964580411365e-01) * q - 2.400758277161838) * q -
           2.549732539343734) *
              q +
          4.374664141464968) *
             q +
         2.938163982698783) /
        ((((7.784695709041462e-03 * q + 3.224671290700398e-01) * q + 2.445134137142996) * q +
          3.754408661907416) *
             q +
         1.);
  } else {
    const double q = p - 0.5, r = q * q;
    x = (((((-3.969683028665376e+01 * r + 2.209460984245205e+02) * r - 2.759285104469687e+02) * r +
           1.383577518672690e+02) *
              r -
          3.066479806614716e+01) *
             r +
         2.506628277459239) *
        q /
        (((((-5.447609879822406e+01 * r + 1.615858368580409e+02) * r - 1.556989798598866e+02) * r +
           6.680131188771972e+01) *
              r -
          1.328068155288572e+01) *
             r +
         1.);
  }
  const double error = 0.5 * std::erfc(-x / std::sqrt(2.)) - p;
  const double step = error * std::sqrt(2. * M_PI) * std::exp(0.5 * x * x);
  x -= step / (1. + 0.5 * x * step);
  return probability < 0.5 ? x : -x;
}

} // namespace eunoe::discovery
