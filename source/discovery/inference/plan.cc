#include <eunoe/discovery/inference/amplitude_posterior.h>
#include <eunoe/discovery/inference/describe.h>
#include <eunoe/discovery/inference/plan.h>
#include <eunoe/discovery/inference/unmeasured.h>
#include <eunoe/discovery/statistics/covariance.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

using tuned::held_out::run_shares;

/// A measurement: some of the modes of one experiment, as linear functions of the coordinates.
struct Measurable
{
  std::string experiment, observable;
  Eigen::MatrixXd rows;
};

std::vector<Measurable> measurables(const Target &target)
{
  std::vector<Measurable> result;
  const Eigen::Index n = target.data().size();
  for (const Target::Part &part : target.experiments()) {
    Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(part.emulator.size(), n);
    modes.middleCols(part.first, part.emulator.size()) =
        part.emulator.unwhitening() * part.rotation.transpose();
    result.push_back({part.measured.name, "all", modes});
    for (const Modes::Group &group : part.emulator.modes().groups())
      result.push_back(
          {part.measured.name, group.observable, modes(group.modes, Eigen::seqN(0, modes.cols()))});
  }
  return result;
}

/// What is to be expected of an experiment if a model is true.
struct Expectation
{
  Predictive twins;                ///< examples
  Predictive amplitudes;           ///< densely, so that one of them is close to any example
  std::vector<double> log_weights; ///< of the amplitudes; none: equal ones
};

/// A model's prediction of one measurement: the t-distribution of the evidence for each amplitude
/// that it may have, over all nuisances.
class Forecast
{
public:
  Forecast(const Measurable &what, const Predictive &predictive, std::vector<double> log_weights,
           const double dof)
      : constants(std::move(log_weights)), dof(dof)
  {
    constants.resize(predictive.draws().size(), 0.);
    const double total = log_sum(constants);
    for (std::size_t i = 0; i < constants.size(); ++i) {
      const Predictive::Conditional &draw = predictive.draws()[i];
      const Eigen::MatrixXd columns = what.rows * draw.columns;
      means.emplace_back(what.rows * draw.mean);
      parts.emplace_back(what.rows * draw.variance.asDiagonal() * what.rows.transpose() +
                         columns * columns.transpose());
      constants[i] -= total + half_log_determinant(parts.back());
    }
  }

  double log_density(const Eigen::VectorXd &value) const
  {
    std::vector<double> logs;
    for (std::size_t i = 0; i < means.size(); ++i) {
      const double distance = parts[i].matrixL().solve(value - means[i]).squaredNorm();
      logs.push_back(constants[i] -
                     0.5 * (dof + static_cast<double>(value.size())) * std::log1p(distance / dof));
    }
    return log_sum(logs);
  }

private:
  std::vector<double> constants;
  const double dof;
  std::vector<Eigen::VectorXd> means;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> parts;
};

/// @return bits
double information(const Measurable &what, const std::vector<Model> &models,
                   const std::vector<Expectation> &expectations, const double dof)
{
  std::vector<Forecast> forecasts;
  for (const Expectation &one : expectations)
    forecasts.emplace_back(what, one.amplitudes, one.log_weights, dof);
  double bits = 0.;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const Eigen::MatrixXd values = what.rows * expectations[m].twins.twins();
    for (Eigen::Index i = 0; i < values.cols(); ++i) {
      std::vector<double> logs;
      for (std::size_t k = 0; k < models.size(); ++k)
        logs.push_back(std::log(models[k].probability) + forecasts[k].log_density(values.col(i)));
      bits += models[m].probability / static_cast<double>(values.cols()) *
              (logs[m] - log_sum(logs) - std::log(models[m].probability)) / std::log(2.);
    }
  }
  // No measurement tells less than nothing; below zero is the error of few twins.
  return std::max(0., bits);
}

double separation(const Measurable &what, const Predictive &a, const Predictive &b)
{
  const Eigen::MatrixXd half = what.rows * Eigen::MatrixXd(a.covariance().matrixL());
  return Eigen::LLT<Eigen::MatrixXd>(half * half.transpose())
      .matrixL()
      .solve(what.rows * (a.mean() - b.mean()))
      .norm();
}

/// Ranks the observables of experiments, and whole experiments, by the information that measuring
/// them is expected to give about which model is true: the mean fall of the entropy of the models'
/// probabilities over twins of each model (bit). The best come first.
Json rank_measurements(const Likelihood &likelihood, std::vector<Model> models,
                       const std::vector<Expectation> &expectations)
{
  double sum = 0., entropy = 0.;
  for (const Model &model : models)
    sum += model.probability;
  for (Model &model : models) {
    model.probability = std::max(1e-6, model.probability / sum);
    entropy -= model.probability * std::log2(model.probability);
  }
  std::vector<std::pair<double, Json>> rows;
  for (const Measurable &what : measurables(likelihood.target())) {
    const double bits = information(what, models, expectations, likelihood.degrees_of_freedom());
    double least = 1e300;
    for (std::size_t m = 1; m < expectations.size(); ++m)
      least = std::min(least, separation(what, expectations[0].twins, expectations[m].twins));
    rows.emplace_back(bits, Json{{"experiment", what.experiment},
                                 {"observable", what.observable},
                                 {"information", bits},
                                 {"of", entropy},
                                 {"separation", expectations.size() > 1 ? least : 0.}});
  }
  return largest_first(std::move(rows));
}

/// An effect before anything is measured, at an amplitude: nuisances have their prior.
PosteriorDraw prior_draw(const std::size_t effect, const double amplitude,
                         const Eigen::VectorXd &nuisances)
{
  const Eigen::Index n = nuisances.size();
  return {{{effect, amplitude}},
          {Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Identity(n, n)},
          nuisances};
}

/// The same at amplitudes by their prior, anywhere between the places.
PosteriorDraws draw_prior(const Evidence &evidence, const std::size_t effect,
                          const unsigned int draws, RandomStream &random)
{
  const std::vector<Evidence::Place> &places = evidence.places(effect);
  const auto n = static_cast<Eigen::Index>(evidence.space().n_nuisances());
  PosteriorDraws result;
  for (unsigned int i = 0; i < draws; ++i) {
    double left = random.uniform();
    std::size_t drawn = 0;
    while (drawn + 1 < places.size() && (left -= std::exp(places[drawn].log_prior)) > 0.)
      ++drawn;
    double amplitude = places[drawn].amplitude;
    const std::size_t next = drawn + 1;
    if (next < places.size() && places[next].amplitude / amplitude > 1.)
      amplitude *= std::pow(places[next].amplitude / amplitude, random.uniform());
    result.push_back(prior_draw(effect, amplitude, random.normals(n, 1).col(0)));
  }
  return result;
}

/// Runs that run_near makes at one amplitude, or on one side of a nuisance.
unsigned int runs_at_each(const unsigned int runs)
{
  return std::max(1u, runs / tuned::held_out::at_each_one_in);
}

/// Most runs of an experiment that it makes for one model.
unsigned int most_runs_near(const unsigned int runs)
{
  return static_cast<unsigned int>(std::size(run_shares)) * runs_at_each(runs);
}

/// What run_near needs of the base model.
std::vector<DesignPoint> base_near(const unsigned int runs, const FactorSpace &space)
{
  return points_of_base(space, tuned::held_out::of_base * runs, runs_at_each(runs));
}

} // namespace

std::uint64_t runs_to_test(const unsigned int models, const unsigned int runs,
                           const std::vector<std::string> &experiments, const Samples &samples)
{
  std::uint64_t result = experiments.size() * models * most_runs_near(runs);
  for (const DesignPoint &point : base_near(runs, samples.space()))
    for (const std::string &experiment : experiments)
      result += samples.n_missing(point, experiment);
  return result;
}

void run_near(const Evidence &evidence, const std::vector<Model> &models, const unsigned int runs,
              const std::vector<std::string> &experiments, Samples &samples)
{
  std::vector<DesignPoint> points = base_near(runs, samples.space());
  for (const Model &model : models)
    for (const std::size_t k : model.effects) {
      const AmplitudePosterior posterior(evidence, model, evidence.target().data(), k);
      for (const double share : run_shares) {
        const double amplitude = posterior.quantile(share);
        if (samples.has_near(k, amplitude, most_runs_near(runs), experiments))
          continue;
        points.push_back({samples.space().origin(), runs_at_each(runs)});
        points.back().position(static_cast<Eigen::Index>(k)) = amplitude;
      }
    }
  samples.complete(points, experiments);
}

Json plan_for_tie(const Evidence &evidence, const Findings &findings, const StudyOptions &options,
                  Samples &samples)
{
  using tuned::plan::most_models;
  constexpr unsigned int draws = 100;
  std::vector<Model> models = findings.answer;
  // One effect or none of the catalogue: nothing is known of what would tell them apart.
  if (models.size() < 2)
    return Json::array();
  if (models.size() > most_models)
    models.resize(most_models);
  const auto rank = [&](const Target &where, const unsigned int seed) {
    std::vector<Expectation> expectations;
    for (const Model &model : models)
      expectations.push_back(
          {{where, draw_posterior(evidence, model, draws, options.seed), seed},
           {where, draw_posterior(evidence, model, draws, options.seed + 1), seed},
           {}});
    return rank_measurements(Likelihood(where), models, expectations);
  };
  Json rows = rank(evidence.target(), options.seed + 5);
  for (Json &row : rows)
    row["again"] = true;
  if (!options.further_experiments.empty())
    run_near(evidence, models, options.validate_runs, options.further_experiments, samples);
  // What else could be measured: further experiments, and more in those that were made.
  std::vector<std::string> experiments = options.further_experiments, made;
  std::set<DataPoint> known;
  for (const Target::Part &part : evidence.target().experiments()) {
    made.push_back(part.measured.name);
    known.insert(part.measured.points.begin(), part.measured.points.end());
  }
  // Where a model was not run it would seem to change nothing, and much to be learnt.
  const auto is_unknown = [&](const std::string &experiment) {
    return std::any_of(models.begin(), models.end(), [&](const Model &model) {
      return std::any_of(model.effects.begin(), model.effects.end(),
                         [&](const std::size_t k) { return !samples.has_any(k, {experiment}); });
    });
  };
  experiments.erase(std::remove_if(experiments.begin(), experiments.end(), is_unknown),
                    experiments.end());
  experiments.insert(experiments.end(), made.begin(), made.end());
  try {
    const auto measured = imagined(experiments, samples, known);
    if (!measured.empty()) {
      for (Json row : rank(Target(measured, samples, options.model_tolerance), options.seed + 6)) {
        row["again"] = false;
        if (row["observable"] == "all" &&
            std::find(made.begin(), made.end(), row["experiment"].get<std::string>()) != made.end())
          row["observable"] = "all else";
        rows.push_back(row);
      }
    }
  } catch (const TooFewRuns &) {
    // The answer does not depend on what a further experiment, whose runs fail, would have told.
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Json &a, const Json &b) {
    return a.at("information").get<double>() > b.at("information").get<double>();
  });
  return rows;
}

nlohmann::ordered_json plan(const StudyOptions &options,
                            const std::vector<std::string> &experiments,
                            const std::vector<Factor> &factors, Simulator &simulator, Log &log)
{
  constexpr unsigned int draws = 60;
  Unmeasured unmeasured(options, experiments, factors, simulator);
  unmeasured.run();
  const Samples &samples = unmeasured.samples;
  log.line("  " + std::to_string(samples.n_known() + samples.n_asked()) + " runs");
  const FactorSpace &space = unmeasured.space;
  const Target target = unmeasured.target();
  const Evidence evidence(target, space);
  const Eigen::VectorXd unmoved =
      space.origin().tail(static_cast<Eigen::Index>(space.n_nuisances()));
  RandomStream random(options.seed, 37);
  std::vector<Model> models;
  std::vector<Expectation> expectations;
  for (std::size_t k = 0; k < space.n_effects(); ++k) {
    if (evidence.places(k).empty() || !samples.has_any(k, experiments))
      continue;
    PosteriorDraws all;
    std::vector<double> log_weights;
    for (const Evidence::Place &place : evidence.places(k)) {
      all.push_back(prior_draw(k, place.amplitude, unmoved));
      log_weights.push_back(place.log_prior);
    }
    expectations.push_back({{target, draw_prior(evidence, k, draws, random), options.seed + 7},
                            {target, all, options.seed + 8},
                            log_weights});
    Model model;
    model.effects = {k};
    model.probability = 1. / static_cast<double>(space.n_effects());
    models.push_back(model);
  }
  return rank_measurements(evidence, models, expectations);
}

} // namespace eunoe::discovery
