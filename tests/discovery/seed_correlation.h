#ifndef eunoe_tests_discovery_seed_correlation_h
#define eunoe_tests_discovery_seed_correlation_h

#include "recorded_table.h"

#include <random>

namespace test {

/// The benefit of common random numbers in recorded simulations: the correlation between runs of
/// the base model and of changed models with the same seed.
class SeedCorrelation
{
public:
  SeedCorrelation(const RecordedTable &table, const std::string &experiment)
  {
    for (const RecordedTable::Run *run : table.of(experiment, "base"))
      base[run->seed] = run->values;
    for (const Factor &factor : table.factors) {
      std::map<double, Runs> by_amplitude;
      for (const RecordedTable::Run *run : table.of(experiment, factor.name))
        if (base.count(run->seed) > 0)
          by_amplitude[run->amplitude][run->seed] = run->values;
      // A vibrating spreader does not change a heap, so there is nothing to compare.
      for (const auto &[amplitude, runs] : by_amplitude)
        if (runs.size() > 1 && std::any_of(runs.begin(), runs.end(), [this](const auto &run) {
              return run.second != base.at(run.first);
            }))
          changed.push_back(runs);
    }
  }

  /// Mean over all changed models of the correlation with the base model's runs of the same seeds,
  /// over seeds and data points.
  double mean() const
  {
    return mean_with([](std::uint32_t seed) { return seed; });
  }

  /// Standard deviation of the mean without any correlation: the base model's seeds are exchanged.
  double scatter() const
  {
    constexpr int n_shuffles = 500;
    std::vector<std::uint32_t> seeds;
    for (const auto &[seed, values] : base)
      if (std::any_of(changed.begin(), changed.end(),
                      [seed = seed](const Runs &runs) { return runs.count(seed) > 0; }))
        seeds.push_back(seed);
    std::mt19937 random(1);
    double squares = 0.;
    for (int k = 0; k < n_shuffles; ++k) {
      std::vector<std::uint32_t> shuffled = seeds;
      std::shuffle(shuffled.begin(), shuffled.end(), random);
      std::map<std::uint32_t, std::uint32_t> other;
      for (std::size_t s = 0; s < seeds.size(); ++s)
        other[seeds[s]] = shuffled[s];
      const double value = mean_with([&](std::uint32_t seed) { return other.at(seed); });
      squares += value * value;
    }
    return std::sqrt(squares / n_shuffles);
  }

private:
  using Runs = std::map<std::uint32_t, Eigen::VectorXd>; ///< values of data points by seed

  template <typename SeedOfBase>
  double mean_with(const SeedOfBase &seed_of_base) const
  {
    double sum = 0.;
    for (const Runs &runs : changed) {
      const auto rows = static_cast<Eigen::Index>(runs.size());
      Eigen::MatrixXd a(rows, base.begin()->second.size()), b = a;
      Eigen::Index row = 0;
      for (const auto &[seed, values] : runs) {
        a.row(row) = values.transpose();
        b.row(row++) = base.at(seed_of_base(seed)).transpose();
      }
      a.rowwise() -= a.colwise().mean().eval();
      b.rowwise() -= b.colwise().mean().eval();
      // All data points have the same weight, whatever their units.
      const Eigen::ArrayXd scale = (a.colwise().norm().array() * b.colwise().norm().array());
      const Eigen::ArrayXd product = (a.cwiseProduct(b)).colwise().sum().array();
      sum += (scale > 0.).select(product / scale, 0.).mean();
    }
    return sum / static_cast<double>(changed.size());
  }

  Runs base;
  std::vector<Runs> changed;
};

} // namespace test

#endif
