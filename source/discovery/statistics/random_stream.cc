#include <eunoe/core/random.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <boost/math/special_functions/erf.hpp>

#include <algorithm>
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
  const std::uint64_t bits = (std::uint64_t(block[2 * place]) << 32 | block[2 * place + 1]) >> 11;
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
  // Double precision throughout: a wider type would take several times as long and gain no digit.
  using Plain = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return -std::sqrt(2.) * boost::math::erfc_inv(2. * probability, Plain());
}

} // namespace eunoe::discovery
