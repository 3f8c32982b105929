// The parts of the inference against closed formulas and against twins of a known truth.

#include <eunoe/discovery/inference/amplitude_posterior.h>
#include <eunoe/discovery/inference/design.h>
#include <eunoe/discovery/inference/predictive.h>

#include "synthetic.h"

#include <mpi.h>

namespace {

using namespace test;

const std::vector<std::string> both = {"spreading", "heap"};

/// Runs of a synthetic model, and an evaluation of data of a truth.
struct Laboratory
{
  Laboratory(const Nature &nature, unsigned int seed)
      : simulator(nature), options(), space(simulator.factors()),
        samples(options, space, simulator, both), design(options, space, samples, both)
  {
    options.seed = seed;
    design.run_base();
    design.run_effects([this] { return target({}, 1); });
  }

  Target target(const Amplitudes &truth, std::uint32_t seed)
  {
    std::vector<std::string> notes;
    return Target(sort_by_experiment(simulator.measure(both, {}, truth, 4, 0.3, seed).fit, samples,
                                     simulator, notes),
                  samples, space, 0.);
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

void likelihoods(Laboratory &lab)
{
  const Target target = lab.target({}, 3);
  const Evidence evidence(target, lab.space);
  const auto &place = evidence.places(1)[20];
  const Target::Prediction &p = place.hypothesis.prediction;
  Eigen::MatrixXd covariance = p.gradient * p.gradient.transpose();
  covariance.diagonal() += target.variance(p);
  const Eigen::VectorXd d = target.data() - p.mean;
  const double distance = d.dot(covariance.inverse() * d);
  check("Mahalanobis distance",
        std::abs(evidence.distance(place.hypothesis, target.data()) / distance - 1.) < 1e-8);
  const auto n = static_cast<double>(d.size());
  const double dof = std::max(10., target.degrees_of_freedom() + 1. - n);
  const double log_determinant =
      2. * Eigen::MatrixXd(covariance.llt().matrixL()).diagonal().array().log().sum();
  check("t-likelihood",
        std::abs(evidence.log_likelihood(place.hypothesis, target.data()) + 0.5 * log_determinant +
                 0.5 * (dof + n) * std::log1p(distance / dof)) < 1e-7);
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
  const Predictive predictive(evidence, draw_posterior(evidence, nothing, 400, 1), 2);
  Twins twins(evidence, 3);
  const PosteriorDraws draws = draw_posterior(evidence, nothing, number, 4);
  for (int k = 0; k < number; ++k) {
    alarms += null.p(evidence.log_bayes_factor(twins.draw(evidence.nothing().prediction))) < 0.1;
    Target::Prediction truth = evidence.nothing().prediction;
    truth.mean += truth.gradient * draws.nuisances[static_cast<std::size_t>(k)];
    truth.gradient.resize(truth.mean.size(), 0);
    refuted += predictive.p(twins.draw(truth)) < 0.1;
  }
  const double error = 4. * std::sqrt(0.1 * 0.9 / number);
  check("level of the test that nothing is missing",
        std::abs(alarms / double(number) - 0.1) < error, std::to_string(alarms));
  check("level of the test of a prediction", std::abs(refuted / double(number) - 0.1) < error,
        std::to_string(refuted));
  const double a = lab.simulator.amplitude_of("b", 8., both);
  check("a wrong prediction is refuted", predictive.p(lab.target({{"b", a}}, 5).data()) < 1e-4);
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

/// The quantiles of one amplitude whatever another one is, against a fine grid of both.
void pairs()
{
  constexpr int on_each_side = 150, rounds = 8;
  constexpr double strength = 10., farthest = 0.75, step = farthest / on_each_side;
  Laboratory lab(nature(), 1);
  const Amplitudes truth = {{"c", lab.simulator.amplitude_of("c", strength, both)},
                            {"d", lab.simulator.amplitude_of("d", strength, both)}};
  for (int k = 0; k < rounds; ++k) {
    const Target target = lab.target(truth, 3);
    const Evidence evidence(target, lab.space);
    lab.design.refine(evidence, evidence.models(target.data()), 0.);
  }
  const Target target = lab.target(truth, 3);
  const Evidence evidence(target, lab.space);
  const Eigen::VectorXd &data = target.data();
  const Model model = evidence.models(data).front();
  check("both effects are found", model.effects == std::vector<std::size_t>{2, 3});
  const std::size_t a = 2, b = 3;
  std::vector<double> logs;
  std::map<double, std::vector<double>> by_amplitude;
  for (int i = -on_each_side; i <= on_each_side; ++i)
    for (int j = -on_each_side; j <= on_each_side; ++j) {
      const double u = model.best.at(a) * std::exp(step * i),
                   v = model.best.at(b) * std::exp(step * j);
      const auto here = evidence.prepare(target.predict({{a, u}, {b, v}}));
      logs.push_back(evidence.log_likelihood(here, data) + evidence.place_near(a, u).log_reference +
                     evidence.place_near(b, v).log_reference);
      by_amplitude[u].push_back(logs.back());
    }
  double sum = 0., low = 0., high = 0.;
  for (const auto &[u, values] : by_amplitude) {
    sum += std::exp(log_sum(values) - log_sum(logs));
    low = sum < 0.05 ? u : low;
    high = sum < 0.95 ? u : high;
  }
  const AmplitudePosterior posterior(evidence, model, data, a);
  const double width = (posterior.quantile(0.95) - posterior.quantile(0.05)) / (high - low);
  check("an interval of one of them allows for the other", std::abs(width - 1.) < 0.04,
        std::to_string(width));
}

} // namespace

EUNOE_MPI_TEST()
{
  Laboratory lab(nature(), 1);
  likelihoods(lab);
  levels(lab);
  calibrations(lab);
  pairs();
}
