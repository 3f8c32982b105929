#ifndef eunoe_discovery_tuned_h
#define eunoe_discovery_tuned_h

#include <cstddef>
#include <cstdint>

namespace eunoe::discovery {

// All numbers that decide what a study answers, or how often it is right, and that could have been
// chosen otherwise. (Besides them there is what a study file says, StudyOptions. Grids, iterations
// and limits of arithmetic stand where they are used: answers should hardly depend on them.)
//
// Constants were chosen on laboratory A (doc/discovery_rates.md). Where one was compared with
// another value, or with nothing, the comparison stands beside it. "As first set": the history of
// the code knows no other value and no comparison; what the number is for is all of its reason.

/// What an answer is, by probabilities and p-values.
struct DecisionRule
{
  /// Probability that the models of an answer must have together; "none of these" is listed with
  /// more than it leaves. Larger: fewer wrong names, more ties. As first set.
  double credible = 0.95;
  /// A model that data lie this far from does not describe them. Smaller than the level of the
  /// study, as many models are looked at. To ask for p above 0.3 in the fit did not help against
  /// names of what the catalogue lacks (doc/discovery_rates.md).
  double refuted = 0.01;
  /// Where data lie this far from a model, "none of these" stays in the answer. As first set.
  double doubtful = 0.05;
  /// Twins of the base model, of single effects, and of predictions. 400 tell a p of 0.001 within a
  /// factor of three or so (doc/discovery_json.md); else as first set.
  unsigned int null_draws = 400, twins = 300, predictive_draws = 400;

  /// With fewer draws, for the rounds before the last.
  DecisionRule quick() const
  {
    return {credible, refuted, doubtful, null_draws / 2, twins / 2, predictive_draws / 2};
  }
};

/// What is not estimated from runs: prior probabilities of the models, given that something is
/// missing. Each share is divided equally among the models of its kind.
struct Prior
{
  double one_effect = 0.88; ///< a model lacks one effect of the catalogue as a rule: the rest
  /// Seldom two: with 0.2 a pair stands too readily for what is not in the catalogue. On laboratory
  /// A 11 instead of 9 of 20 deleted effects are off the catalogue with 0.02, and 11 instead of 12
  /// of 16 pairs are named (7c376b2).
  double two_effects = 0.02;
  /// Or something that is not in the catalogue. Ten times as likely it did not help against names
  /// of what the catalogue lacks (doc/discovery_rates.md).
  double none_of_these = 0.1;
  /// Strength of the smallest amplitude: below a standard deviation of a run nothing is seen.
  double just_visible = 1.;
  double least_range = 1e-3; ///< smallest amplitude that is considered, in scales; as first set
  /// Share of an effect's probability by ratios of amplitude, the rest by ratios of strength, so
  /// that the prior neither depends on how an effect is parametrised nor favours narrow ranges. As
  /// first set.
  double by_amplitude = 0.1;
  /// Strengths off the catalogue, and the share of them along changes like the catalogue's, the
  /// rest along any. As first set.
  double weakest_discrepancy = 3., strongest_discrepancy = 48., along_effects = 0.5;
};

namespace tuned {

/// How the scatter of runs is estimated.
namespace scatter {

/// Cosine modes of one observable that count: only the finest waves of long profiles are left out.
/// As first set.
inline constexpr int most_modes = 8;
/// A scatter below this share of its observable's typical one is not believed, so that a difference
/// in the last digit is not significant. As first set.
inline constexpr double least_share = 0.2;
/// An effect whose change is smaller than this, in standard deviations of a run, tells of the base
/// model's scatter. With those of all effects the base model's twins have heavy tails: thresholds
/// stood at log Bayes factors of 5 to 9 instead of 2 to 3 (a8afbba). The 4 is as first set.
inline constexpr double weak = 4.;
/// And if the variances of its modes grow alike within this factor. Scatter in proportion to a
/// mode's change was taken off instead; that made the covariance 10 % too small (20ba823). The 1.5
/// is as first set.
inline constexpr double alike = 1.5;
/// Growth of variance as a whole, at most, and the standard deviation of its logarithm's prior,
/// which keeps it near that of the base model where few replicates tell. As first set.
inline constexpr double most_growth = 10., growth_deviation = 0.7;
/// Mean of the prior of the share of its own change by which a mode scatters. In the heaps of the
/// third suite profiles have 0.1, most modes none and heights half (doc/discovery_json.md). As
/// first set.
inline constexpr double typical_share = 0.1;
/// How much a deviation tells of scatter: chaos is not normal, and modes are correlated beyond what
/// shrinkage leaves. As first set.
inline constexpr double independent_share = 0.5;
/// Degrees of freedom of the likelihood of data, at least: few runs would give fewer. As first set.
inline constexpr double least_degrees = 10.;

} // namespace scatter

/// How an effect may change a value along its amplitude: candidates among which runs choose
/// (GaussianProcess). All as first set.
namespace kernel {

/// Of the amplitude: a response may be steep near zero.
inline constexpr double powers[] = {0.45, 0.7, 1.};
/// Variance of the Brownian motion over that of the straight line.
inline constexpr double roughness[] = {0.03, 0.3, 1.};
/// How much the change depends on the nuisances; or not at all.
inline constexpr double interactions[] = {0.01, 0.05, 0.2};
/// From nothing to a strong effect, in variances of a run: most effects change few values by much
/// (42cfbd4).
inline constexpr double variances[] = {0., 0.01, 0.16, 2.5, 40., 650., 1e4};
/// Values that each of these variances has in advance, when their distribution is fitted.
inline constexpr double in_advance = 0.5;

} // namespace kernel

/// What the instrument adds to the variance of runs, in units of the latter.
namespace instrument {

/// Median of the prior: an instrument is chosen such that its noise is a small part, as a rule. As
/// first set.
inline constexpr double usual = 0.1;
/// An observable that scatters more than this says nothing about the others, as it hardly varies
/// between runs. As first set.
inline constexpr double coarsest = 10.;
/// Levels of equal probability that stand for the posterior, as few repeats leave it uncertain by
/// more than its usual size (42cfbd4). Work grows with them; five are as first set.
inline constexpr std::size_t n_levels = 5;

} // namespace instrument

/// What is made of twins.
namespace twins {

/// Beyond the largest of so many draws the tail of a statistic is exponential. A p of 0.001 is
/// right within a factor of three or so (24,000 twins; doc/discovery_json.md). As first set.
inline constexpr std::size_t tail_one_in = 10;
/// Evidence is tempered at least by this, as twins know nothing of what is wrong with the model
/// besides (0.7 until a8afbba), and at most by that, as first set.
inline constexpr double least_temperature = 1., highest_temperature = 3.;
/// Share of twins in which a detectable amplitude is detected. As first set.
inline constexpr double power = 0.8;
/// An effect whose range ends this far below the strength of the data is no lookalike: a strength
/// is known to one standard deviation, its unit. As first set. Weaker twins said that what
/// resembles none is recognised in 37 %, and it was in 70 % (14 studies of strength 8; 5193b0c).
inline constexpr double clearly_weaker = 2.;

} // namespace twins

/// Where runs go.
namespace runs {

/// Of a design point: two give the scatter there. As first set.
inline constexpr unsigned int replicates = 2;
/// Amplitudes of the first look: ratio of the next to the last, the strength below which an effect
/// has no smaller one, in standard deviations of a run, and their number. As first set.
inline constexpr double amplitude_ratio = 1. / 3., just_visible = 3.;
inline constexpr int most_amplitudes = 6;
/// Part of an emulator's error that is taken off the square of that strength (in the evidence it is
/// all of it). As first set; no reason is noted.
inline constexpr double error_taken_off = 0.5;
/// Nuisances of the base model's runs, in prior deviations on either side, and the largest of those
/// that are drawn for runs of effects. As first set.
inline constexpr double nuisance_step = 2., most_nuisance = 2.;
/// Design points of a round: so many at least, and as many as one in so many of the runs before
/// need. As first set.
inline constexpr std::uint64_t fewest_points = 8, one_in = 10;
/// Of a round's runs. Half of them while nothing was found, before all runs told of the base model
/// (36e6919). The tenth is as first set.
inline constexpr double share_of_base = 0.1;
/// Hopes of models are tempered by this, as they are not certain. As first set.
inline constexpr double temperature_of_hopes = 2.;
/// Runs for the amplitudes of an answer: likelihoods are tempered such that runs which lie far from
/// the data by chance do not keep others from being made there (bdbfe1e), and runs end at this
/// share of emulators' error in the variance. It widens an interval by a tenth. As first
/// set.
inline constexpr double temperature_of_amplitudes = 4., known_amplitude = 0.2;
/// Runs whose amplitudes differ by less than this share are runs of one amplitude. As first set.
inline constexpr double near = 0.2;
/// Failures without a success that close an amplitude, as one may be by chance: before, 73 of 1,800
/// runs of a suite failed at places that had failed (fb5fcd8). As first set.
inline constexpr std::size_t too_many_failures = 2;

} // namespace runs

/// When a study has its answer.
namespace ending {

/// Equal rounds, and probabilities of the first model that are equal. As first set.
inline constexpr std::size_t rounds = 3;
inline constexpr double same_probability = 0.05;
/// Equal rounds where nothing is found and p is less than so many times the level (but never where
/// it is larger than that), as it may cross the level by chance. Without an end there, studies
/// spent every budget (35adbb8). Six and four are as first set.
inline constexpr std::size_t rounds_near_level = 6;
inline constexpr double near_level = 4., not_near_level = 0.5;
/// Probability with which another model could join. It is measured by the whole probability, as by
/// a twentieth of the first model's a tie of several would never end (89ef7dd). As first set.
inline constexpr double challenger = 0.05;
/// Standard deviations by which a likelihood may turn out larger than expected, as an effect could
/// be detected by chance, too (71b5b82). As first set.
inline constexpr double luck = 1.5;
/// An answer is settled if the first model has this probability, or if its emulators' errors have
/// less than this share of the variance. As first set.
inline constexpr double sure = 0.99, well_known = 0.15;

} // namespace ending

/// Tests on held-out data.
namespace held_out {

/// Of what the base model leaves of the budget, one in so many runs at most is kept for tests, as
/// without an answer there is nothing to test: 144 of 200 had been kept, and the base model needed
/// 60 (b16354a). A half is as first set.
inline constexpr std::uint64_t kept_one_in = 2;
/// Shares of a model's posterior at which it is run. As first set.
inline constexpr double run_shares[] = {0.1, 0.5, 0.9};
/// Runs of the base model, in those that a study asks for of each model; and one in so many of
/// these at each amplitude and on each side of a nuisance. As first set.
inline constexpr unsigned int of_base = 2, at_each_one_in = 2;
/// Models that are tested: those of the answer, and others that held-out data might speak for. As
/// first set.
inline constexpr std::size_t most_tested = 4;
/// And in each further round of the rest of the answer, where it has many models or others have
/// taken the place of refuted ones (dcdf608: a dozen pairs did). As first set.
inline constexpr std::size_t most_followed = 3;
inline constexpr unsigned int most_rounds = 3;
/// A result is in doubt between these p, in those at which a model is refuted and doubtful, and
/// gets so many times the runs, as far as the budget has room. As first set.
inline constexpr double clearly = 0.1, hardly = 4.;
inline constexpr unsigned int in_doubt = 3;

} // namespace held_out

/// Measurements that are proposed.
namespace plan {

/// Of what is not measured yet. As first set.
inline constexpr unsigned int repeats = 4;
/// The likeliest of a tie, which are to be told apart. As first set.
inline constexpr unsigned int most_models = 4;

} // namespace plan

} // namespace tuned

} // namespace eunoe::discovery

#endif
