#ifndef eunoe_discovery_inference_predictive_h
#define eunoe_discovery_inference_predictive_h

#include <eunoe/discovery/inference/calibration.h>

#include <vector>

namespace eunoe::discovery {

/// Posterior of the nuisances for fixed effects, in prior deviations: a normal distribution by its
/// mean and a root of its covariance.
struct NuisancePosterior
{
  Eigen::VectorXd mean;
  Eigen::MatrixXd root;
};
NuisancePosterior nuisances_given(const Evidence &evidence, const EffectPositions &effects);

/// A model with amplitudes and nuisances as the data of the fit leave them uncertain: a draw from
/// the posterior.
struct PosteriorDraw
{
  EffectPositions effects;
  NuisancePosterior given; ///< these effects
  Eigen::VectorXd nuisances;
};
using PosteriorDraws = std::vector<PosteriorDraw>;

/// @param model without effects: nothing is missing
PosteriorDraws draw_posterior(const Evidence &evidence, const Model &model, unsigned int draws,
                              std::uint32_t seed);

/// How well a model fits the data that it was fitted to: the probability of a smaller likelihood of
/// the best amplitudes if the model is true. Twins of the model are fitted as the data were, so
/// that nothing is gained by having been chosen.
/// @param model one that explains the data at its `best` amplitudes
double p_of_fit(const Evidence &evidence, const Model &model, const PosteriorDraws &posterior,
                std::uint32_t seed);

/// How well a model predicts measured data: the probability of data that are as unlikely as these
/// if the model is true, by twins of the prediction. There is no least value.
/// @param target the data that are predicted, with emulators of their experiments
class Predictive
{
public:
  Predictive(const Target &target, const PosteriorDraws &posterior, std::uint32_t seed);

  double p(const Eigen::VectorXd &data) const { return p(log_density(data)(0)); }
  double p(double log_density) const { return tail.p(-log_density); }
  const Eigen::VectorXd &mean() const { return centre; }
  /// Of data about the mean.
  const Eigen::LLT<Eigen::MatrixXd> &covariance() const { return llt; }

  /// Data if the effects of a draw are true, and the nuisances anything that the posterior allows.
  struct Conditional
  {
    Eigen::VectorXd mean, variance;
    Eigen::MatrixXd columns; ///< what nuisances add to the covariance, by its root
  };
  const std::vector<Conditional> &draws() const { return all; }

  /// An example of each, in columns.
  const Eigen::MatrixXd &twins() const { return examples; }
  /// Logarithm of the probability density of data in columns, whatever the level of the
  /// instrument's noise is, but for a constant.
  Eigen::ArrayXd log_density(const Eigen::Ref<const Eigen::MatrixXd> &data) const;

private:
  std::vector<Conditional> all;
  Eigen::MatrixXd examples;
  Eigen::VectorXd centre;
  Eigen::LLT<Eigen::MatrixXd> llt;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> levels; ///< of the covariance, by noise
  Tail tail;
};

/// Competing models that predict the same data. One is refuted not only where it does not describe
/// them, but also where another predicts them so much better as it rarely does if the first is true
/// (the most powerful test between two; Neyman and Pearson 1933). Twins tell how rarely.
class Contest
{
public:
  explicit Contest(std::vector<Predictive> models);

  /// Probability of data that speak against a model as much as these do if it is true.
  double p(std::size_t model, const Eigen::VectorXd &data) const
  {
    return p_values(model, data)(0);
  }
  /// Share of another model's twins that a model is refuted by at a level.
  double refuted_by(std::size_t model, std::size_t truth, double level) const;
  /// Probability that data of something else would not refute a model at a level. Some of the other
  /// models stand for something else, by Laplace's rule of succession: one half without any.
  double passes(std::size_t model, const std::vector<std::size_t> &others, double level) const;

private:
  /// Log densities of data in columns, a row for each model.
  Eigen::ArrayXXd log_densities(const Eigen::Ref<const Eigen::MatrixXd> &data) const;
  /// That of the best of the others over that of a model.
  static Eigen::ArrayXd advantage(std::size_t model, const Eigen::ArrayXXd &log_densities);
  /// Of data in columns.
  Eigen::ArrayXd p_values(std::size_t model, const Eigen::Ref<const Eigen::MatrixXd> &data) const;

  std::vector<Predictive> models;
  std::vector<Tail> tails; ///< of the advantage over each model if it is true
};

} // namespace eunoe::discovery

#endif
