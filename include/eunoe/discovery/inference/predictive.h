#ifndef eunoe_discovery_inference_predictive_h
#define eunoe_discovery_inference_predictive_h

#include <eunoe/discovery/inference/calibration.h>

#include <vector>

namespace eunoe::discovery {

/// A model with amplitudes and nuisances as the data of the fit leave them uncertain: draws from
/// the posterior.
struct PosteriorDraws
{
  std::vector<std::map<std::size_t, double>> effects;
  std::vector<Eigen::VectorXd> nuisances;
  /// What the nuisances were drawn from, for the effects of each draw: a normal distribution by its
  /// mean and a root of its covariance.
  std::vector<Eigen::VectorXd> nuisance_means;
  std::vector<Eigen::MatrixXd> nuisance_roots;
};

/// @param model without effects: nothing is missing
PosteriorDraws draw_posterior(const Evidence &evidence, const Model &model, unsigned int draws,
                              std::uint32_t seed);

/// Best values of the nuisances for fixed effects, in prior deviations.
Eigen::VectorXd best_nuisances(const Evidence &evidence, const Hypothesis &hypothesis);

/// How well a model fits the data that it was fitted to: the probability of a smaller likelihood of
/// the best amplitudes if the model is true. Twins of the model are fitted as the data were, so
/// that nothing is gained by having been chosen.
/// @param model one that explains the data at its `best` amplitudes
double p_of_fit(const Evidence &evidence, const Model &model, const PosteriorDraws &posterior,
                std::uint32_t seed);

/// How well a model predicts measured data: the probability of data that are as unlikely as these
/// if the model is true, by twins of the prediction. There is no least value.
/// @param evidence of the data that are predicted, with emulators of their experiments
class Predictive
{
public:
  Predictive(const Evidence &evidence, const PosteriorDraws &posterior, std::uint32_t seed);

  double p(const Eigen::VectorXd &data) const { return tail.p(surprise(data)(0)); }
  const Eigen::VectorXd &mean() const { return centre; }
  /// Share of another model's twins that this one is refuted by at a level.
  double refuted_by(const Predictive &truth, double level) const;
  /// Of data about the mean.
  const Eigen::LLT<Eigen::MatrixXd> &covariance() const { return llt; }

  /// Data if the effects of a draw are true, and the nuisances anything that the posterior allows.
  struct Conditional
  {
    Eigen::VectorXd twin; ///< an example
    Eigen::VectorXd mean, variance;
    Eigen::MatrixXd columns; ///< what nuisances add to the covariance, by its root
  };
  const std::vector<Conditional> &draws() const { return all; }

private:
  /// Of data in columns: less the logarithm of their probability density, whatever the level of the
  /// instrument's noise is.
  Eigen::ArrayXd surprise(const Eigen::Ref<const Eigen::MatrixXd> &data) const;

  std::vector<Conditional> all;
  Eigen::VectorXd centre;
  Eigen::LLT<Eigen::MatrixXd> llt;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> levels; ///< of the covariance, by noise
  Tail tail;
};

} // namespace eunoe::discovery

#endif
