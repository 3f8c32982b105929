#ifndef eunoe_discovery_inference_evidence_h
#define eunoe_discovery_inference_evidence_h

#include <eunoe/discovery/inference/likelihood.h>
#include <eunoe/discovery/tuned.h>

#include <optional>
#include <vector>

namespace eunoe::discovery {

/// A model: effects that are missing, none for "nothing", or a discrepancy of no catalogued shape.
struct Model
{
  std::vector<std::size_t> effects;
  bool is_discrepancy = false;
  double log_prior = 0., log_evidence = 0., probability = 0.;
  EffectPositions best; ///< likeliest amplitudes
};

/// Whether one of the models has the same effects.
bool is_among(const Model &model, const std::vector<Model> &models);
/// Whether a model has all effects of another one.
bool is_part(const Model &part, const Model &whole);

/// Gives models their probabilities by the evidence to the power of one over the temperature, and
/// sorts them. Priors stay what they are: models of two effects are many.
void temper(std::vector<Model> &models, double temperature);
/// The likeliest come first.
void sort_by_probability(std::vector<Model> &models);

/// Marginal likelihoods of all models: amplitudes are integrated, too.
class Evidence : public Likelihood
{
public:
  Evidence(const Target &target, const FactorSpace &space);

  /// An amplitude of an effect on the grid over which it is integrated.
  struct Place
  {
    double amplitude, log_prior;
    /// Weight for intervals, uniform in strength: Jeffreys' prior, whose intervals cover a fixed
    /// truth as often as stated where the proper prior would pull them to small amplitudes.
    double log_reference;
    /// Size of the change in standard deviations of a run, without the emulator's error; it does
    /// not fall as the amplitude grows.
    double strength;
    Hypothesis hypothesis;
  };
  const std::vector<Place> &places(std::size_t effect) const { return grid[effect]; }
  /// The place nearest to an amplitude.
  const Place &place_near(std::size_t effect, double amplitude) const;
  const FactorSpace &space() const { return factors; }

  /// Log of prior and optimistic likelihood of an effect's places.
  std::vector<double> optimistic(std::size_t effect, double deviations = 0.) const;
  /// The same of a pair of effects at its best amplitudes.
  double optimistic_pair(const Model &pair) const;
  /// Effects that were simulated, and so have places.
  const std::vector<std::size_t> &usable() const { return effects; }

  /// Log evidence of nothing for data in columns.
  Eigen::ArrayXd log_nothing(const Eigen::Ref<const Eigen::MatrixXd> &data) const
  {
    return log_likelihoods(nothing(), data);
  }
  /// The model of an effect, without its probability.
  Model single(std::size_t effect, const Eigen::VectorXd &data) const;

  /// Log Bayes factors of "an effect is missing, or something else" against nothing.
  Eigen::ArrayXd log_bayes_factors(const Eigen::Ref<const Eigen::MatrixXd> &data) const;

  /// Models that lack one thing, for data in columns: a row for each usable effect, and last the
  /// discrepancy.
  struct Singles
  {
    Eigen::ArrayXd log_prior; ///< of the models, which share all probability
    Eigen::ArrayXXd log_evidence;

    /// Log of prior and evidence.
    Eigen::ArrayXXd log_posterior(const double temperature = 1.) const
    {
      return (log_evidence / temperature).colwise() + log_prior;
    }
  };
  /// @param without a usable effect that the catalogue is to lack: its row has no probability
  Singles singles(const Eigen::Ref<const Eigen::MatrixXd> &data,
                  std::optional<std::size_t> without = std::nullopt) const;

  /// Models of one and two effects and the discrepancy with posterior probabilities, the likeliest
  /// first.
  std::vector<Model> models(const Eigen::VectorXd &data) const;

private:
  void make_grid(std::size_t effect);
  using Covariance = Eigen::LLT<Eigen::MatrixXd>;
  /// Of data by a change that is not catalogued, for each size of it and level of noise.
  std::vector<Covariance> make_discrepancies() const;
  /// Evidence and best amplitudes of a pair on a coarse grid.
  /// @param roughly without the levels of the instrument's noise
  void integrate(Model &pair, const Eigen::VectorXd &data, bool roughly) const;
  void polish(Model &pair, const Eigen::VectorXd &data) const;
  /// The places on the side of the null value on which an amplitude lies.
  const Place *side_of(std::size_t effect, double amplitude) const;
  double log_density(std::size_t effect, double amplitude) const;
  Eigen::ArrayXXd log_of_places(std::size_t effect,
                                const Eigen::Ref<const Eigen::MatrixXd> &data) const;
  Eigen::ArrayXd log_discrepancy(const Eigen::Ref<const Eigen::MatrixXd> &data) const;

  const FactorSpace &factors;
  const Prior prior;
  std::vector<std::vector<Place>> grid;
  std::vector<std::size_t> effects;
  std::vector<Covariance> discrepancies;
};

} // namespace eunoe::discovery

#endif
