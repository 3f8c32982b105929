#include <eunoe/discovery/inference/design.h>
#include <eunoe/discovery/inference/plan.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Shares of the posterior at which models are run elsewhere.
constexpr double run_shares[] = {0.1, 0.5, 0.9};

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
      result.push_back({part.measured.name, group.observable, modes(group.modes, Eigen::all)});
  }
  return result;
}

/// A model's prediction of one measurement: a normal distribution for each draw of its posterior.
class Forecast
{
public:
  Forecast(const Measurable &what, const Predictive &predictive)
      : means(what.rows * predictive.draw_means())
  {
    for (Eigen::Index i = 0; i < means.cols(); ++i) {
      parts.emplace_back(what.rows * predictive.draw_variances().col(i).asDiagonal() *
                         what.rows.transpose());
      constants.push_back(-Eigen::MatrixXd(parts.back().matrixL()).diagonal().array().log().sum());
    }
  }

  /// Log density of a value, without the draw that it was made from.
  double log_density(const Eigen::VectorXd &value, const Eigen::Index without) const
  {
    std::vector<double> logs;
    for (Eigen::Index i = 0; i < means.cols(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (i != without)
        logs.push_back(constants[k] -
                       0.5 * parts[k].matrixL().solve(value - means.col(i)).squaredNorm());
    }
    return log_sum(logs) - std::log(static_cast<double>(logs.size()));
  }

private:
  Eigen::MatrixXd means;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> parts;
  std::vector<double> constants;
};

double information(const Measurable &what, const std::vector<Model> &models,
                   const std::vector<Predictive> &predictives)
{
  std::vector<Forecast> forecasts;
  for (const Predictive &one : predictives)
    forecasts.emplace_back(what, one);
  double bits = 0.;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const auto &twins = predictives[m].twin_data();
    for (std::size_t t = 0; t < twins.size(); ++t) {
      const Eigen::VectorXd value = what.rows * twins[t];
      std::vector<double> logs;
      for (std::size_t k = 0; k < models.size(); ++k)
        logs.push_back(std::log(models[k].probability) +
                       forecasts[k].log_density(value, static_cast<Eigen::Index>(t)));
      bits += models[m].probability / static_cast<double>(twins.size()) *
              (logs[m] - log_sum(logs) - std::log(models[m].probability)) / std::log(2.);
    }
  }
  // No measurement tells less than nothing; below zero is the error of few draws with long tails.
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

/// Probabilities that add up to one.
std::vector<Model> normalised(std::vector<Model> models)
{
  double sum = 0.;
  for (const Model &model : models)
    sum += model.probability;
  for (Model &model : models)
    model.probability = std::max(1e-6, model.probability / sum);
  return models;
}

/// All data points of experiments as if each had been measured a few times without an instrument's
/// noise.
std::vector<MeasuredExperiment> imagined(const std::vector<std::string> &experiments,
                                         const Samples &samples, const Simulator &simulator,
                                         const unsigned int repeats)
{
  std::vector<MeasuredPoint> points;
  for (const std::string &experiment : experiments) {
    const auto &names = simulator.data_points(experiment);
    for (std::size_t c = 0; c < names.size(); ++c) {
      std::vector<double> values;
      bool complete = true;
      for (const Sample &sample : samples.of(experiment)) {
        const double value = sample.values(static_cast<Eigen::Index>(c));
        complete = complete && std::isfinite(value);
        if (sample.position.isZero(0.))
          values.push_back(value);
      }
      double mean = 0., square = 0.;
      for (const double value : values)
        mean += value / static_cast<double>(values.size());
      for (const double value : values)
        square += std::pow(value - mean, 2);
      const double deviation = std::sqrt(square / std::max<double>(1., values.size() - 1.));
      if (complete && deviation > 0.)
        points.push_back({names[c], mean, deviation, repeats});
    }
  }
  std::vector<std::string> notes;
  return sort_by_experiment(points, samples, simulator, notes);
}

} // namespace

unsigned int most_runs_near(const unsigned int runs)
{
  return static_cast<unsigned int>(std::size(run_shares)) * std::max(1u, runs / 2);
}

unsigned int runs_of_base(const unsigned int runs, const std::size_t n_nuisances)
{
  return 2 * runs + 2 * static_cast<unsigned int>(n_nuisances) * std::max(1u, runs / 2);
}

void run_near(const Evidence &evidence, const std::vector<Model> &models, const unsigned int runs,
              const FactorSpace &space, const std::vector<std::string> &experiments,
              Samples &samples)
{
  const unsigned int few = std::max(1u, runs / 2);
  std::vector<DesignPoint> points = {{space.origin(), 2 * runs}};
  constexpr double step = 2.;
  for (std::size_t q = 0; q < space.n_nuisances(); ++q)
    for (const double side : {-step, step}) {
      points.push_back({space.origin(), few});
      points.back().position(static_cast<Eigen::Index>(space.n_effects() + q)) = side;
    }
  for (const Model &model : models)
    for (const std::size_t k : model.effects) {
      const AmplitudePosterior posterior =
          amplitude_posterior(evidence, k, evidence.target().data(), model);
      for (const double share : run_shares) {
        points.push_back({space.origin(), few});
        points.back().position(static_cast<Eigen::Index>(k)) = posterior.quantile(share);
      }
    }
  for (DesignPoint &point : points)
    point.replicates = samples.n_missing(point, experiments);
  samples.run(points, experiments);
}

Json rank_measurements(const Evidence &evidence, const std::vector<Model> &models,
                       const std::vector<Predictive> &predictives)
{
  const std::vector<Model> candidates = normalised(models);
  double entropy = 0.;
  for (const Model &model : candidates)
    entropy -= model.probability * std::log2(model.probability);
  std::vector<std::pair<double, Json>> rows;
  for (const Measurable &what : measurables(evidence.target())) {
    const double bits = information(what, candidates, predictives);
    double least = 1e300;
    for (std::size_t m = 1; m < predictives.size(); ++m)
      least = std::min(least, separation(what, predictives[0], predictives[m]));
    rows.emplace_back(-bits, Json{{"experiment", what.experiment},
                                  {"observable", what.observable},
                                  {"information", bits},
                                  {"of", entropy},
                                  {"separation", predictives.size() > 1 ? least : 0.}});
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto &a, const auto &b) { return a.first < b.first; });
  Json list = Json::array();
  for (const auto &[bits, row] : rows)
    list.push_back(row);
  return list;
}

Json plan_for_tie(const Evidence &evidence, const Findings &findings, const StudyOptions &options,
                  const FactorSpace &space, Samples &samples)
{
  constexpr std::size_t most_models = 4;
  constexpr unsigned int draws = 100, repeats = 4;
  std::vector<Model> models = findings.answer;
  if (models.size() > most_models)
    models.resize(most_models);
  const auto rank = [&](const Evidence &where, const unsigned int seed) {
    std::vector<Predictive> predictives;
    for (const Model &model : models)
      predictives.emplace_back(where, draw_posterior(evidence, model, draws, options.seed), seed);
    return rank_measurements(where, models, predictives);
  };
  Json rows = rank(evidence, options.seed + 5);
  for (Json &row : rows)
    row["again"] = true;
  if (!options.further_experiments.empty()) {
    run_near(evidence, models, options.validate_runs, space, options.further_experiments, samples);
    const auto measured =
        imagined(options.further_experiments, samples, samples.simulator(), repeats);
    if (!measured.empty()) {
      const Target target(measured, samples, space, options.model_tolerance);
      for (Json row : rank(Evidence(target, space), options.seed + 6)) {
        row["again"] = false;
        rows.push_back(row);
      }
    }
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
  constexpr unsigned int draws = 60, repeats = 4;
  const FactorSpace space(factors);
  Samples samples(options, space, simulator, experiments);
  Design design(options, space, samples, experiments);
  design.run_base();
  const auto estimate = [&] {
    return Target(imagined(experiments, samples, simulator, repeats), samples, space, 0.);
  };
  design.run_effects(estimate);
  log.line("  " + std::to_string(samples.n_known() + samples.n_asked()) + " runs");
  const Target target = estimate();
  const Evidence evidence(target, space);
  RandomStream random(options.seed, 37);
  std::vector<Model> models;
  std::vector<Predictive> predictives;
  for (std::size_t k = 0; k < space.n_effects(); ++k) {
    if (evidence.places(k).empty())
      continue;
    PosteriorDraws prior;
    for (unsigned int i = 0; i < draws; ++i) {
      const auto &places = evidence.places(k);
      prior.effects.push_back({{k, places[random.index(places.size())].amplitude}});
      prior.nuisances.push_back(
          random.normals(static_cast<Eigen::Index>(space.n_nuisances()), 1).col(0));
    }
    Model model;
    model.effects = {k};
    model.probability = 1. / static_cast<double>(space.n_effects());
    models.push_back(model);
    predictives.emplace_back(evidence, prior, options.seed + 7);
  }
  return rank_measurements(evidence, models, predictives);
}

} // namespace eunoe::discovery
