#ifndef eunoe_discovery_inference_amplitude_posterior_h
#define eunoe_discovery_inference_amplitude_posterior_h

#include <eunoe/discovery/inference/evidence.h>

#include <utility>
#include <vector>

namespace eunoe::discovery {

/// A model at amplitudes that the data allow, and their posterior probability, with Jeffreys'
/// prior.
struct Member
{
  EffectPositions effects;
  Target::Prediction prediction;
  double probability = 0.;
};

/// Log of the posterior density of amplitudes up to a constant, with Jeffreys' prior.
/// @param likeliest amplitudes, whose variance it has: with the variance of each, those near which
/// many runs were made, or where runs scatter less, would be favoured, by an error that is itself
/// known roughly
/// @param prediction of the amplitudes
double log_density(const Evidence &evidence, const Hypothesis &likeliest,
                   const EffectPositions &effects, const Target::Prediction &prediction,
                   const Eigen::VectorXd &data);

/// All places of one effect. For two effects a grid of both amplitudes, as large as the posterior.
/// Their probabilities sum to one.
/// @param model with one or two effects
std::vector<Member> members(const Evidence &evidence, const Model &model,
                            const Eigen::VectorXd &data);

/// Posterior of one effect's amplitude, whatever the other one's is.
class AmplitudePosterior
{
public:
  AmplitudePosterior(const Evidence &evidence, const Model &model, const Eigen::VectorXd &data,
                     std::size_t effect);

  /// Amplitude below which this much of the probability lies.
  double quantile(double share) const;
  /// From the smallest to the largest of the amplitudes with the highest likelihood that hold this
  /// much of the probability together. A range between two quantiles would always leave out the end
  /// of the effect's range, though it be the likeliest amplitude of all.
  std::pair<double, double> likeliest(double probability) const;
  /// Probability of all amplitudes that are likelier than this one: it lies in every range that
  /// holds more.
  double likelier_than(double amplitude) const;

  struct Place
  {
    double amplitude, probability;
    double log_likelihood; ///< up to a constant: of the probability over Jeffreys' prior
  };
  /// In ascending order.
  const std::vector<Place> &places() const { return sorted; }

private:
  double log_likelihood_at(double amplitude) const;

  std::vector<Place> sorted;
  /// Each place stands for the amplitudes half-way to its neighbours, in several parts.
  struct Slice
  {
    double low, high, probability, log_likelihood;
  };
  std::vector<Slice> slices;
};

} // namespace eunoe::discovery

#endif
