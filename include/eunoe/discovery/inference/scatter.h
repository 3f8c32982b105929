#ifndef eunoe_discovery_inference_scatter_h
#define eunoe_discovery_inference_scatter_h

#include <Eigen/Dense>
#include <vector>

namespace eunoe::discovery {

/// How much runs with an effect scatter, as variances over that of the base model. Chaos grows as a
/// whole, exponentially with the root of the amplitude; besides, the change of each mode differs
/// from run to run by a share of itself: the height of a heap that an attraction has made twice as
/// high scatters far more than anything in the base model.
class Scatter
{
public:
  /// Runs at one position.
  struct Replicates
  {
    int effect = -1;        ///< the only one; -1: none, -2: several
    double amplitude = 0.;  ///< of that effect
    Eigen::VectorXd change; ///< of the mean, in whitened modes
    Eigen::VectorXd square; ///< sum of the squared deviations from the mean, of each mode
    double runs = 1.;

    /// Squared change, less what the noise of the mean adds.
    Eigen::ArrayXd squared_change() const;
    /// Logarithm of the likelihood of each mode's deviations, up to a constant.
    Eigen::ArrayXd log_likelihood(const Eigen::ArrayXd &variance) const;
  };

  Scatter() = default;
  Scatter(std::size_t n_effects, const std::vector<Replicates> &all);

  /// Growth as a whole. It is not below 1: data that happen to lie nearer than expected would
  /// speak for any effect with less scatter.
  double common(std::size_t effect, double amplitude) const;
  /// Of each mode.
  /// @param change of the mean by the effect, in whitened modes
  Eigen::VectorXd of_modes(std::size_t effect, double amplitude,
                           const Eigen::VectorXd &change) const;
  /// The likeliest growth as a whole, be it below 1.
  double likeliest(std::size_t effect, double amplitude) const;

private:
  void fit_growth(std::size_t effect, const std::vector<const Replicates *> &groups);
  void fit_shares(std::size_t effect, const std::vector<const Replicates *> &groups);

  std::vector<double> growth, largest; ///< per effect: exponent, at this amplitude
  Eigen::MatrixXd shares;              ///< squared, modes x effects
};

} // namespace eunoe::discovery

#endif
