#ifndef eunoe_discovery_statistics_random_stream_h
#define eunoe_discovery_statistics_random_stream_h

#include <Eigen/Dense>

#include <array>
#include <cstdint>

namespace eunoe::discovery {

/// Random numbers for bootstraps: the same sequence for the same seed and stream everywhere.
class RandomStream
{
public:
  RandomStream(std::uint32_t seed, std::uint32_t stream) : key({{seed, stream}}) {}

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

/// The number below which a standard normal variable stays with this probability, to 1e-9
/// relative.
/// @param probability in (0, 1)
double normal_quantile(double probability);

} // namespace eunoe::discovery

#endif
