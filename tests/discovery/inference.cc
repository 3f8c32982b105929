// The parts of the inference against closed formulas and against twins of a known truth.

#include <eunoe/discovery/inference/amplitude_posterior.h>
#include <eunoe/discovery/inference/decision.h>
#include <eunoe/discovery/inference/design.h>
#include <eunoe/discovery/inference/predictive.h>
#include <eunoe/discovery/statistics/covariance.h>

#include "suite.h"
#include "synthetic.h"

#include <mpi.h>
#include <numeric>

namespace {

using namespace test;

const std::vector<std::string> both = {"spreading", "heap"};

/// Runs of a synthetic model, and an evaluation of data of a truth.
struct Laboratory
{
  /// @param alike effects whose fingerprints are those of others
  Laboratory(const Nature &nature, unsigned int seed, const StudyOptions &study = {},
             const std::map<std::string, std::string> &alike = {})
      : simulator(nature), options(study), space(simulator.factors()),
        samples(options, space, simulator, both), design(options, space, samples, both)
  {
    options.seed = seed;
    for (const auto &[name, other] : alike)
      simulator.make_alike(name, other, 0., both);
    design.run_base();
    design.run_effects([this] { return target({}, 1); });
  }

  Target target(const Amplitudes &truth, std::uint32_t seed, const double tolerance = 0.)
  {
    return Target(sort_by_experiment(simulator.measure(both, {}, truth, 4, 0.3, seed).fit, samples),
                  samples, tolerance);
  }

  SyntheticSimulator simulator;
  StudyOptions options;
  FactorSpace space;
  Samples samples;
  Design design;
};

Nature nature()
{
  Nature result;
  result.n_effects = 4;
  result.n_nuisances = 1;
  result.seed = 5;
  return result;
}

/// What the model may be wrong by is in the likelihood and in twins alike.
void tolerances(Laboratory &lab)
{
  constexpr unsigned int draws = 2000;
  double with_out[2];
  for (const bool with : {false, true}) {
    const Target target = lab.target({}, 3, with ? 0.1 : 0.);
    const Evidence evidence(target, lab.space);
    const Target::Prediction &nothing = evidence.nothing().prediction;
    Twins twins(target, 1);
    const double of_twins =
        (twins.draw(nothing, draws).colwise() - nothing.mean).squaredNorm() / draws;
    with_out[with] = target.variance(nothing).sum() + nothing.gradient.squaredNorm();
    check("twins scatter as the likelihood says", std::abs(of_twins / with_out[with] - 1.) < 0.1,
          std::to_string(of_twins) + ", " + std::to_string(with_out[with]));
  }
  check("with the model's tolerance more", with_out[true] > 1.5 * with_out[false],
        std::to_string(with_out[true] / with_out[false]));
}

void likelihoods(Laboratory &lab)
{
  const Target target = lab.target({}, 3);
  const Evidence evidence(target, lab.space);
  const auto &place = evidence.places(1)[20];
  const Target::Prediction &p = place.hypothesis.prediction;
  const Eigen::VectorXd d = target.data() - p.mean;
  const auto n = static_cast<double>(d.size());
  const double dof = std::max(10., target.degrees_of_freedom() + 1. - n);
  std::vector<double> logs;
  double worst = 0.;
  const Eigen::VectorXd distances = place.hypothesis.distances(d);
  const Eigen::MatrixXd variances = target.variances(p);
  for (std::size_t l = 0; l < Target::n_noise_levels; ++l) {
    Eigen::MatrixXd covariance = p.gradient * p.gradient.transpose();
    covariance.diagonal() += variances.col(static_cast<Eigen::Index>(l));
    const double distance = d.dot(covariance.llt().solve(d));
    worst = std::max(worst, std::abs(distances(static_cast<Eigen::Index>(l)) / distance - 1.));
    logs.push_back(-half_log_determinant(covariance.llt()) -
                   0.5 * (dof + n) * std::log1p(distance / dof));
  }
  check("Mahalanobis distance", worst < 1e-8);
  check("t-likelihood, the noise integrated",
        std::abs(evidence.log_likelihood(place.hypothesis, target.data()) - log_sum(logs) +
                 std::log(static_cast<double>(Target::n_noise_levels))) < 1e-7);
  double weight = 0.;
  for (const auto &one : evidence.places(1))
    weight += std::exp(one.log_prior);
  check("the prior of amplitudes adds up to one", std::abs(weight - 1.) < 1e-9);
  double sum = 0.;
  for (const Model &model : evidence.models(target.data()))
    sum += model.probability;
  check("the models' probabilities, too", std::abs(sum - 1.) < 1e-9);
}

/// A tenth of the truths must have a p below 0.1, within four standard errors, whether nothing is
/// missing or a model predicts.
void levels(Laboratory &lab)
{
  constexpr int number = 200;
  int alarms = 0, refuted = 0;
  const Target target = lab.target({}, 3);
  const Evidence evidence(target, lab.space);
  const Tail null = null_distribution(evidence, 400, 1);
  Model nothing;
  const Predictive predictive(target, draw_posterior(evidence, nothing, 400, 1), 2);
  Twins twins(target, 3);
  const PosteriorDraws draws = draw_posterior(evidence, nothing, number, 4);
  for (int k = 0; k < number; ++k) {
    alarms +=
        null.p(evidence.log_bayes_factors(twins.draw(evidence.nothing().prediction))(0)) < 0.1;
    Target::Prediction truth = evidence.nothing().prediction;
    truth.mean += truth.gradient * draws[static_cast<std::size_t>(k)].nuisances;
    truth.gradient.resize(truth.mean.size(), 0);
    refuted += predictive.p(twins.draw(truth)) < 0.1;
  }
  const double error = 4. * std::sqrt(0.1 * 0.9 / number);
  check("level of the test that nothing is missing",
        std::abs(alarms / double(number) - 0.1) < error, std::to_string(alarms));
  check("level of the test of a prediction", std::abs(refuted / double(number) - 0.1) < error,
        std::to_string(refuted));
  const double a = lab.simulator.amplitude_of("b", 8., both);
  const double p_wrong = predictive.p(lab.target({{"b", a}}, 5).data());
  check("a wrong prediction is refuted", p_wrong < 1e-4, std::to_string(p_wrong));
}

/// Rows of the runs that made the covariance are as far from their mean, over all directions, as
/// new runs are, but for the share by which twins are shortened where distances count.
void distances_of_twins(Laboratory &lab)
{
  constexpr unsigned int number = 1000;
  double new_ones = 0., of_rows = 0., shortened = 0.;
  const Target target = lab.target({}, 3);
  for (const Target::Part &part : target.experiments()) {
    const ExperimentEmulator &emulator = part.emulator;
    Eigen::MatrixXd fresh(number, emulator.size());
    for (unsigned int k = 0; k < number; ++k) {
      const MeasuredData data = lab.simulator.measure({part.measured.name}, {}, {}, 1, 0., 100 + k);
      Eigen::VectorXd values(part.measured.value.size());
      for (std::size_t c = 0; c < data.fit.size(); ++c)
        values(static_cast<Eigen::Index>(c)) = data.fit[c].value;
      fresh.row(k) = emulator.whiten(values).transpose();
    }
    const double rows = emulator.deviations().rowwise().squaredNorm().mean();
    new_ones += centred(fresh).rowwise().squaredNorm().mean();
    of_rows += rows;
    shortened += (1. - emulator.own_share()) * rows;
  }
  check("twins are as far away as new runs", std::abs(shortened / new_ones - 1.) < 0.05,
        std::to_string(shortened / new_ones));
  check("and not as far as they are along the weights", of_rows / new_ones > 1.05,
        std::to_string(of_rows / new_ones));

  const Evidence evidence(target, lab.space);
  Target::Prediction truth = evidence.nothing().prediction;
  truth.gradient.resize(truth.mean.size(), 0);
  truth.leverage.setZero();
  const auto distance = [&](const Twins::Scatter scatter) {
    const Eigen::MatrixXd drawn = Twins(target, 4, scatter).draw(truth, number);
    return (drawn.colwise() - truth.mean).colwise().squaredNorm().mean();
  };
  const double weighed = distance(Twins::Scatter::as_weighed),
               by_distance = distance(Twins::Scatter::as_a_distance);
  truth.scatter.setZero();
  const double of_instrument = distance(Twins::Scatter::as_weighed),
               ratio = (by_distance - of_instrument) / (weighed - of_instrument);
  check("which twins know", std::abs(ratio - shortened / of_rows) < 0.02, std::to_string(ratio));
}

/// Points that were measured once scatter more than those that were measured nine times.
void unequal_repeats(Laboratory &lab)
{
  constexpr unsigned int often = 9, number = 300;
  const auto measure = [&](const unsigned int k) {
    std::vector<MeasuredPoint> points;
    for (const std::string &experiment : both) {
      const auto once = lab.simulator.measure(experiment, {}, 1, 0., 5000 + 10 * k);
      auto nine = lab.simulator.measure(experiment, {}, often, 0., 5000 + 10 * k);
      for (std::size_t c = 0; c < nine.size(); ++c) {
        const bool is_seldom = nine[c].point.observable == nine.front().point.observable;
        points.push_back(nine[c]);
        points.back().value = is_seldom ? once[c].value : nine[c].value;
        points.back().repeats = is_seldom ? 1 : often;
      }
    }
    return Target(sort_by_experiment(points, lab.samples), lab.samples, 0.);
  };
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(measure(0).data().size());
  for (unsigned int k = 0; k < number; ++k) {
    const Target target = measure(k);
    const Target::Prediction nothing = target.predict({});
    // Coordinates turn with the measured deviations, so they are compared by their order.
    Eigen::ArrayXd squares =
        (target.data() - nothing.mean).array().square() / target.variance(nothing).array() / number;
    const Eigen::ArrayXd variance = target.variance(nothing).array();
    std::vector<Eigen::Index> order(static_cast<std::size_t>(sum.size()));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](const Eigen::Index a, const Eigen::Index b) {
      return variance(a) < variance(b);
    });
    for (Eigen::Index c = 0; c < sum.size(); ++c)
      sum(c) += squares(order[static_cast<std::size_t>(c)]);
  }
  check("the least certain points are as uncertain as they are said to be",
        sum.tail(2).mean() > 0.6 && sum.tail(2).mean() < 1.5, std::to_string(sum.tail(2).mean()));
  check("and the most certain ones", sum.head(4).mean() > 0.6 && sum.head(4).mean() < 1.5,
        std::to_string(sum.head(4).mean()));
}

/// A model that another one predicts the data better than is refuted far more often than by its own
/// misfit if it is wrong, and no more often than the level says if it is true.
void contests(Laboratory &lab)
{
  const double amplitude = lab.simulator.amplitude_of("b", 4., both);
  const Target target = lab.target({{"b", amplitude}}, 3);
  const Evidence evidence(target, lab.space);
  const std::vector<Model> models = evidence.models(target.data());
  const auto likeliest = [&](const bool is_right) {
    return *std::find_if(models.begin(), models.end(), [&](const Model &model) {
      return model.effects.size() == 1 && (model.effects[0] == 1) == is_right;
    });
  };
  const auto predict = [&](const bool is_right, const std::uint32_t seed) {
    return Predictive(target, draw_posterior(evidence, likeliest(is_right), 400, seed), seed);
  };
  const Predictive fresh = predict(true, 7), right = predict(true, 2), wrong = predict(false, 2);
  const Contest contest({right, wrong});
  constexpr double level = 0.05;
  unsigned int truths = 0, alone = 0, against_right = 0;
  for (Eigen::Index k = 0; k < fresh.twins().cols(); ++k) {
    const Eigen::VectorXd twin = fresh.twins().col(k);
    truths += contest.p(0, twin) < level;
    alone += wrong.p(twin) < level;
    against_right += contest.p(1, twin) < level;
  }
  const auto number = static_cast<double>(fresh.twins().cols());
  const double error = 4. * std::sqrt(level * (1. - level) / number);
  check("a contest keeps its level", truths / number < level + error, std::to_string(truths));
  check("a contest refutes more wrong models",
        against_right > alone + 4. * std::sqrt(alone) && alone > 0,
        std::to_string(alone) + ", " + std::to_string(against_right));
  check_close("and says how often it will", contest.refuted_by(1, 0, level), against_right / number,
              0.1);
  check_close("and how rarely something else passes", contest.passes(1, {0}, level),
              (2. - against_right / number) / 3., 0.05);
  check_close("of which nothing is known without another model", contest.passes(1, {}, level), 0.5,
              0.);
  // Data beyond the right model.
  const Eigen::VectorXd beyond = 2. * right.mean() - wrong.mean();
  check("a model is better than another one beyond it",
        right.log_density(beyond)(0) > wrong.log_density(beyond)(0));
  check_close("the better model is refuted by its own misfit alone", contest.p(0, beyond),
              std::min(1., 2. * right.p(beyond)), 0.);
}

/// Most runs have one effect, as where a study has followed a false trail. Data without any effect,
/// but with nuisances, must not look like it.
void false_trail()
{
  Nature more = nature();
  more.n_nuisances = 2;
  StudyOptions few;
  few.null_runs = 16;
  few.nuisance_runs = 4;
  Laboratory lab(more, 1, few);
  RandomStream random(6, 1);
  const std::size_t b = 1;
  std::vector<DesignPoint> points;
  for (int k = 0; k < 150; ++k) {
    Eigen::VectorXd position = lab.space.origin();
    position(static_cast<Eigen::Index>(b)) = 0.01 * lab.space.upper(b) * (1. + random.uniform());
    for (Eigen::Index q = static_cast<Eigen::Index>(lab.space.n_effects()); q < position.size();
         ++q)
      position(q) = random.normal();
    points.push_back({position, 2});
  }
  lab.samples.run(points, both);
  constexpr int number = 60;
  int alarms = 0;
  for (std::uint32_t k = 0; k < number; ++k) {
    SuiteCase one = draw_case(lab.simulator, {"none"}, both, k, random);
    const Target target = lab.target(one.truth, 100 + k);
    const Evidence evidence(target, lab.space);
    alarms +=
        null_distribution(evidence, 100, 1).p(evidence.log_bayes_factors(target.data())(0)) < 0.05;
  }
  check("runs with an effect make no false alarms of it", alarms <= 8, std::to_string(alarms));
}

/// An effect of which there are no runs, as no experiment of the fit can have it or all fail, is no
/// model that changes nothing: it is none.
void without_runs()
{
  SyntheticSimulator simulator(nature());
  StudyOptions options;
  const FactorSpace space(simulator.factors());
  Samples samples(options, space, simulator, both);
  Design design(options, space, samples, both);
  design.run_base();
  const auto evaluate = [&] {
    return Target(sort_by_experiment(simulator.measure(both, {}, {}, 4, 0.3, 3).fit, samples),
                  samples, 0.);
  };
  {
    const Target target = evaluate();
    const Evidence evidence(target, space);
    check("without runs no effect is a model", evidence.usable().empty());
    const std::vector<Model> models = evidence.models(target.data());
    check("and 'none of the catalogue' is all that is left",
          models.size() == 1 && models.front().is_discrepancy);
    check("which can be weighed", std::isfinite(evidence.log_bayes_factors(target.data())(0)));
  }
  constexpr std::size_t c = 2;
  DesignPoint one{space.origin(), 2};
  one.position(static_cast<Eigen::Index>(c)) = 1.;
  samples.run({one}, {"heap"});
  const Target target = evaluate();
  check("runs in one experiment make it one",
        Evidence(target, space).usable() == std::vector<std::size_t>{c});
  check("which is not known everywhere", samples.has_any(c, {"heap"}) && !samples.has_any(c, both));
}

/// Each experiment gets the replicates that it lacks.
void completing()
{
  SyntheticSimulator simulator(nature());
  StudyOptions options;
  const FactorSpace space(simulator.factors());
  Samples samples(options, space, simulator, both);
  samples.run({{space.origin(), 3}}, {"heap"});
  const DesignPoint base{space.origin(), 4};
  check("missing replicates",
        samples.n_missing(base, "heap") == 1 && samples.n_missing(base, "spreading") == 4);
  for (int i = 0; i < 2; ++i) {
    samples.complete({base}, both);
    check("are run once", samples.n_asked() == 8, std::to_string(samples.n_asked()));
  }
}

/// An observable that is the same in all runs, such as what never falls into a gap, is judged by
/// the scatter of its measurement.
void constant_observable()
{
  Nature still = nature();
  still.constant = "mass";
  Laboratory lab(still, 3);
  constexpr std::uint32_t number = 30;
  int alarms = 0;
  for (std::uint32_t k = 0; k < number; ++k) {
    std::vector<MeasuredPoint> data = lab.simulator.measure(both, {}, {}, 4, 0.3, 700 + k).fit;
    for (MeasuredPoint &point : data)
      if (point.point.observable == still.constant && k % 2 == 0)
        point.repeats = 1;
    const Target target(sort_by_experiment(data, lab.samples), lab.samples, 0.);
    const Evidence evidence(target, lab.space);
    alarms +=
        null_distribution(evidence, 100, 1).p(evidence.log_bayes_factors(target.data())(0)) < 0.05;
  }
  // More than 6 of 30 at a true rate of 5 % would be a chance of 0.1 %.
  check("a constant observable makes no false alarms", alarms <= 6, std::to_string(alarms));
}

void calibrations(Laboratory &lab)
{
  const Target target = lab.target({}, 3);
  const Evidence evidence(target, lab.space);
  const Tail null = null_distribution(evidence, 200, 1);
  const Calibration c = calibrate(evidence, null.quantile(0.05), 400, 1);
  check("twins are found", c.twins > 100, std::to_string(c.twins));
  check("as often as stated", std::abs(c.stated - c.right) < 0.1,
        std::to_string(c.stated) + ", " + std::to_string(c.right));
  check("intervals cover as often as stated", c.coverage > 0.9 && c.coverage < 0.99,
        std::to_string(c.coverage));
  const auto seen = detectable(evidence, 1, true, null.quantile(0.05), 1);
  check("what is detectable is visible and weak",
        seen && lab.simulator.strength({{"b", lab.space.effect(1).scale * *seen}}, both) > 1. &&
            lab.simulator.strength({{"b", lab.space.effect(1).scale * *seen}}, both) < 6.,
        seen ? std::to_string(*seen) : "none");
}

/// A study goes on while a model could join its answer: with a twentieth of the probability, all
/// amplitudes of an effect together, or as likelier than the model to which it adds an effect.
void challenge(Laboratory &lab)
{
  constexpr std::size_t a = 0, b = 1, c = 2;
  constexpr double by_chance = 1.5;
  const Target target = lab.target({}, 3);
  const Evidence evidence(target, lab.space);
  const std::vector<Model> models = evidence.models(target.data());
  const auto find = [&](const std::vector<std::size_t> &effects) {
    return *std::find_if(models.begin(), models.end(), [&](const Model &model) {
      return !model.is_discrepancy && model.effects == effects;
    });
  };
  // The answer is an effect that is ahead of what another model hopes for.
  const auto is_challenged = [&](const Model &other, const double hope, const double ahead) {
    Findings findings;
    Model first = find({a});
    first.log_prior = other.log_prior;
    first.log_evidence = hope - other.log_prior + ahead;
    first.probability = 0.9;
    findings.models = {first, other};
    findings.answer = {first};
    return has_challenger(evidence, findings);
  };
  const Model single = find({b}), more = find({a, b}), pair = find({b, c});
  const double hope = log_sum(evidence.optimistic(b, by_chance)),
               hope_of_more = evidence.optimistic_pair(more),
               hope_of_pair = evidence.optimistic_pair(pair);
  check("an effect with 7 % challenges an answer", is_challenged(single, hope, 2.5));
  check("and with 3 % it does not", !is_challenged(single, hope, 3.5));
  check("so does a pair",
        is_challenged(pair, hope_of_pair, 2.5) && !is_challenged(pair, hope_of_pair, 3.5));
  check("one that adds to the answer must become likelier",
        !is_challenged(more, hope_of_more, 0.5) && is_challenged(more, hope_of_more, -0.5));
}

/// Of four effects two are alike: each of them, left out, is taken for the other, and the two that
/// resemble none are recognised as none of the catalogue. So a name of one of the two may be that
/// of an effect like them that the catalogue lacks, and a name of the others may hardly be.
void lookalikes()
{
  constexpr std::size_t a = 0, b = 1, c = 2;
  constexpr double strength = 8.;
  Nature apart = nature();
  apart.alike = 0.;
  Laboratory lab(apart, 1, {}, {{"b", "c"}});
  double none[2];
  for (const bool has_relative : {false, true}) {
    const std::string name = has_relative ? "b" : "a";
    const Target target = lab.target({{name, lab.simulator.amplitude_of(name, strength, both)}}, 3);
    const Evidence evidence(target, lab.space);
    none[has_relative] = weigh(evidence, lab.options, {}).off_catalogue;
    const Lookalikes found = find_lookalikes(evidence, strength, 0., 400, 1);
    double sum = found.recognised;
    for (const auto &[effect, share] : found.taken_for)
      sum += share;
    check("each twin is taken for something", std::abs(sum - 1.) < 1e-9);
    std::vector<Model> equal = evidence.models(target.data());
    for (Model &model : equal)
      model.log_evidence = -7.;
    check("evidence is tempered and shares are not",
          std::abs(found.log_evidence(equal, 2.) + 7.) < 1e-9);
    check("effects that are never so strong have no twins",
          find_lookalikes(evidence, 1e3, 0., 400, 1).taken_for.empty());
    check("twins in which nothing is detected do not count",
          find_lookalikes(evidence, strength, 1e9, 400, 1).recognised == 1.);
    const auto share = [&](const std::size_t k) {
      const auto of = found.taken_for.find(k);
      return of == found.taken_for.end() ? 0. : of->second;
    };
    constexpr double of_four = 0.25, error = 0.06;
    // Some twins of those that resemble none are taken for it, too.
    for (const std::size_t alike : {b, c})
      check("an effect is taken for the one like it",
            share(alike) > of_four - error && share(alike) < of_four + 2. * error,
            std::to_string(share(alike)));
    check("and not for another one", share(a) < error, std::to_string(share(a)));
    check("what resembles none is recognised", std::abs(found.recognised - 0.5) < 2. * error,
          std::to_string(found.recognised));
  }
  check("an effect like none has no double off the catalogue", none[false] < 0.02,
        std::to_string(none[false]));
  // A tenth of what is missing is not in the catalogue, and half of that looks like the two.
  const Prior prior;
  const double expected = prior.none_of_these / (prior.none_of_these + prior.one_effect);
  check("an effect with a relative may have another one off the catalogue",
        std::abs(none[true] / expected - 1.) < 0.3,
        std::to_string(none[true]) + ", " + std::to_string(expected));
}

/// Width and lower end of the central 90 % of an effect's posterior on a grid of @p n times @p n
/// amplitudes, each of the two between these factors of the best one.
std::pair<double, double> on_fine_grid(
    const Evidence &evidence, const Target &target, const Model &model, const std::size_t effect,
    const std::map<std::size_t, std::pair<double, double>> &spans)
{
  constexpr int n = 301;
  const auto axis = [&](const std::size_t k) {
    const auto &[low, high] = spans.at(k);
    std::vector<double> result;
    for (int i = 0; i < n; ++i)
      result.push_back(model.best.at(k) * low * std::pow(high / low, i / (n - 1.)));
    return result;
  };
  const std::size_t other = model.effects[model.effects[0] == effect ? 1 : 0];
  const Hypothesis likeliest = evidence.prepare(target.predict(model.best));
  std::vector<double> logs, marginal;
  for (const double u : axis(effect)) {
    logs.clear();
    for (const double v : axis(other)) {
      const std::map<std::size_t, double> effects = {{effect, u}, {other, v}};
      logs.push_back(
          log_density(evidence, likeliest, effects, target.predict(effects), target.data()));
    }
    marginal.push_back(log_sum(logs));
  }
  double sum = 0., low = 0., high = 0.;
  const std::vector<double> amplitudes = axis(effect);
  for (int i = 0; i < n; ++i) {
    sum += std::exp(marginal[i] - log_sum(marginal));
    low = sum < 0.05 ? amplitudes[i] : low;
    high = sum < 0.95 ? amplitudes[i] : high;
  }
  return {high - low, low};
}

/// Data without noise of the very prediction of an effect give its amplitude, although few runs are
/// near it and many near a smaller one.
void unpopular_amplitude()
{
  Laboratory lab(nature(), 1);
  const std::size_t c = 2;
  const Factor &effect = lab.space.effect(c);
  const double amplitude = lab.simulator.amplitude_of("c", 8., both),
               truth = (amplitude - effect.null_value) / effect.scale;
  std::vector<DesignPoint> many;
  for (int k = 0; k < 30; ++k) {
    many.push_back({lab.space.origin(), 2});
    many.back().position(static_cast<Eigen::Index>(c)) = 0.5 * truth;
  }
  lab.samples.run(many, both);
  const Target target = lab.target({{"c", amplitude}}, 3);
  const Evidence evidence(target, lab.space);
  const Eigen::VectorXd data = target.predict({{c, truth}}).mean;
  const double median =
      AmplitudePosterior(evidence, evidence.single(c, data), data, c).quantile(0.5);
  check("an amplitude near which little was run is not disfavoured",
        std::abs(median / truth - 1.) < 0.03, std::to_string(median / truth));
}

/// An interval reaches the end of an effect's range where the data lie there, as two quantiles
/// never do; inside the range it is that between two quantiles.
void intervals(Laboratory &lab)
{
  constexpr std::size_t b = 1;
  constexpr double inside = 0.95;
  const Target target = lab.target({}, 3);
  const Evidence evidence(target, lab.space);
  const auto &places = evidence.places(b);
  const auto of_data_from = [&](const std::size_t place) {
    const Eigen::VectorXd data = places[place].hypothesis.prediction.mean;
    return AmplitudePosterior(evidence, evidence.single(b, data), data, b);
  };
  const double end = places.back().amplitude;
  const AmplitudePosterior at_end = of_data_from(places.size() - 1);
  check("an interval reaches the range's end", at_end.likeliest(inside).second == end,
        std::to_string(at_end.likeliest(inside).second / end));
  check("nothing is likelier than the range's end", at_end.likelier_than(end) == 0.,
        std::to_string(at_end.likelier_than(end)));

  const std::size_t middle = 2 * places.size() / 3;
  const AmplitudePosterior within = of_data_from(middle);
  const auto [low, high] = within.likeliest(inside);
  const double width = (high - low) / (within.quantile(0.975) - within.quantile(0.025));
  check("an interval inside the range is about as wide as that between quantiles",
        std::abs(width - 1.) < 0.15, std::to_string(width));
  check("an interval holds what is likelier than its ends",
        within.likelier_than(0.5 * (low + places[middle].amplitude)) < inside &&
            within.likelier_than(0.9 * low) > inside && within.likelier_than(1.1 * high) > inside,
        std::to_string(within.likelier_than(0.9 * low)));
}

/// Runs are added at the amplitudes of an answer until their error hardly widens its interval.
void sharpened()
{
  constexpr std::size_t c = 2;
  Laboratory lab(nature(), 1);
  const Amplitudes truth = {{"c", lab.simulator.amplitude_of("c", 8., both)}};
  const auto error = [&](const Target &target) {
    const double u = (truth.at("c") - lab.space.effect(c).null_value) / lab.space.effect(c).scale;
    const Target::Prediction prediction = target.predict({{c, u}});
    return target.unknown_share(prediction);
  };
  const double before = error(lab.target(truth, 3));
  const std::uint64_t first = lab.samples.n_asked();
  const auto sharpen = [&] {
    const Target target = lab.target(truth, 3);
    const Evidence evidence(target, lab.space);
    return lab.design.sharpen(evidence, {evidence.single(c, target.data())});
  };
  while (sharpen())
    continue;
  const double after = error(lab.target(truth, 3));
  check("runs make an answer's amplitudes known", before > 0.3 && after < 0.25,
        std::to_string(before) + " to " + std::to_string(after));
  check("and are few", lab.samples.n_asked() - first < 300,
        std::to_string(lab.samples.n_asked() - first));
  check("where nothing is the answer, none are made",
        !lab.design.sharpen(Evidence(lab.target({}, 3), lab.space), {}));
}

/// Log evidence of a pair: prior and likelihood summed over all places of both effects.
double evidence_by_places(const Evidence &evidence, const Target &target, const Model &model)
{
  const std::size_t a = model.effects[0], b = model.effects[1];
  std::vector<double> logs;
  for (const Evidence::Place &p : evidence.places(a))
    for (const Evidence::Place &q : evidence.places(b))
      logs.push_back(p.log_prior + q.log_prior +
                     evidence.log_likelihood(
                         evidence.prepare(target.predict({{a, p.amplitude}, {b, q.amplitude}})),
                         target.data()));
  return log_sum(logs);
}

/// An interval of one of two effects allows for the other's amplitude, and reaches as far down as
/// the data allow where an effect is hardly determined.
void pairs()
{
  constexpr int rounds = 8;
  constexpr std::size_t c = 2, d = 3;
  Laboratory lab(nature(), 1);
  const Amplitudes truth = {{"c", lab.simulator.amplitude_of("c", 10., both)},
                            {"d", lab.simulator.amplitude_of("d", 10., both)}};
  for (int k = 0; k < rounds; ++k) {
    const Target target = lab.target(truth, 3);
    const Evidence evidence(target, lab.space);
    Findings findings;
    findings.models = evidence.models(target.data());
    findings.detected = true;
    lab.design.refine(evidence, findings);
  }
  {
    const Target target = lab.target(truth, 3);
    const Evidence evidence(target, lab.space);
    const Model model = evidence.models(target.data()).front();
    check("both effects are found", model.effects == std::vector<std::size_t>{c, d});
    const double places = evidence_by_places(evidence, target, model);
    check("their evidence is that of all amplitudes", std::abs(model.log_evidence - places) < 0.3,
          std::to_string(model.log_evidence) + ", " + std::to_string(places));
    const AmplitudePosterior posterior(evidence, model, target.data(), c);
    const double width =
        (posterior.quantile(0.95) - posterior.quantile(0.05)) /
        on_fine_grid(evidence, target, model, c, {{c, {0.47, 2.1}}, {d, {0.47, 2.1}}}).first;
    check("an interval of one of them allows for the other", std::abs(width - 1.) < 0.06,
          std::to_string(width));
  }
  const Target target = lab.target({{"c", truth.at("c")}}, 3);
  const Evidence evidence(target, lab.space);
  for (const Model &model : evidence.models(target.data()))
    if (model.effects == std::vector<std::size_t>{c, d}) {
      const double places = evidence_by_places(evidence, target, model);
      check("and so it is with an effect that is not there",
            std::abs(model.log_evidence - places) < 0.3,
            std::to_string(model.log_evidence) + ", " + std::to_string(places));
      double least = 1., most = 1.;
      for (const Evidence::Place &place : evidence.places(d))
        if (const double ratio = place.amplitude / model.best.at(d); ratio > 0.) {
          least = std::min(least, ratio);
          most = std::max(most, ratio);
        }
      const auto [width, low] =
          on_fine_grid(evidence, target, model, d, {{c, {0.47, 2.1}}, {d, {least, most}}});
      const AmplitudePosterior posterior(evidence, model, target.data(), d);
      const double ratio = (posterior.quantile(0.95) - posterior.quantile(0.05)) / width;
      check("an interval of an effect that is not there reaches down",
            posterior.quantile(0.05) < 1.3 * low && std::abs(ratio - 1.) < 0.1,
            std::to_string(posterior.quantile(0.05) / low) + ", " + std::to_string(ratio));
    }
}

} // namespace

EUNOE_MPI_TEST()
{
  Laboratory lab(nature(), 1);
  likelihoods(lab);
  tolerances(lab);
  levels(lab);
  distances_of_twins(lab);
  unequal_repeats(lab);
  contests(lab);
  false_trail();
  without_runs();
  completing();
  constant_observable();
  calibrations(lab);
  challenge(lab);
  lookalikes();
  intervals(lab);
  sharpened();
  pairs();
  unpopular_amplitude();
}
