#ifndef eunoe_discovery_inference_twins_h
#define eunoe_discovery_inference_twins_h

#include <eunoe/discovery/inference/evidence.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <vector>

namespace eunoe::discovery {

/// Data of a known truth as this study would have measured them: the emulator's mean, nuisances
/// from their priors, and scatter of runs that the study has made, which is neither normal nor has
/// the correlations that are assumed.
class Twins
{
public:
  /// New runs scatter more along the directions by which data are weighed than the covariance says,
  /// as it happens to be small there, and as much as it says over all directions together.
  enum class Scatter
  {
    as_weighed,    ///< for comparisons of models, which look along those directions
    as_a_distance, ///< for the distance of data from one model
  };

  Twins(const Target &target, std::uint32_t seed, Scatter scatter = Scatter::as_weighed)
      : target(target), random(seed, 17), kind(scatter)
  {
  }

  /// Data of one truth, in the target's coordinates. The error of the prediction is drawn, too.
  Eigen::VectorXd draw(const Target::Prediction &truth);
  /// Several, in columns.
  Eigen::MatrixXd draw(const Target::Prediction &truth, unsigned int number);

private:
  Eigen::VectorXd instrument(const Target::Part &part, double scatter, double quantile);

  const Target &target;
  RandomStream random;
  const Scatter kind;
};

/// Values of a statistic for draws of a truth, and the probability to be at or above another value.
/// Beyond some of the largest draws the tail is exponential, so that no p-value is limited by
/// their number.
class Tail
{
public:
  Tail() = default;
  explicit Tail(const Eigen::ArrayXd &draws);
  double p(double value) const;
  /// Value with this probability to be exceeded.
  double quantile(double p) const;

private:
  std::vector<double> sorted; ///< from the largest
  double threshold = 0., scale = 1., share = 0.;
};

/// Distribution of the log Bayes factor where nothing is missing.
Tail null_distribution(const Evidence &evidence, unsigned int draws, std::uint32_t seed);

} // namespace eunoe::discovery

#endif
