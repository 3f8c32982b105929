#include <eunoe/core/random.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <boost/random/normal_distribution.hpp>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

std::uint64_t RandomStream::operator()()
{
  const unsigned int place = static_cast<unsigned int>(count % 2);
  if (place == 0) {
    const std::uint64_t number = count / 2;
    block = philox(
        {{static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), 0, 1}},
        key);
  }
  ++count;
  return std::uint64_t(block[2 * place]) << 32 | block[2 * place + 1];
}

double RandomStream::uniform()
{
  return (static_cast<double>((*this)() >> 11) + 0.5) * 0x1p-53;
}

double RandomStream::normal()
{
  return boost::random::normal_distribution<double>()(*this);
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

} // namespace eunoe::discovery
