#ifndef eunoe_discovery_statistics_random_stream_h
#define eunoe_discovery_statistics_random_stream_h

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <limits>

namespace eunoe::discovery {

/// Random numbers for bootstraps: the same sequence for the same seed and stream everywhere.
/// A UniformRandomBitGenerator for distributions of other libraries.
class RandomStream
{
public:
  using result_type = std::uint64_t;

  RandomStream(std::uint32_t seed, std::uint32_t stream) : key({{seed, stream}}) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()();

  /// In (0, 1), without the ends.
  double uniform();
  double normal();
  /// A whole number below `bound`.
  std::size_t index(std::size_t bound);
  /// `rows` x `columns` independent normal numbers.
  Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index columns);

private:
  std::array<std::uint32_t, 2> key;
  std::array<std::uint32_t, 4> block{};
  std::uint64_t count = 0;
};

} // namespace eunoe::discovery

#endif
