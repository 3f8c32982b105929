#include <eunoe/core/problems.h>
#include <eunoe/discovery/stages/study_state.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace eunoe::discovery {

namespace {

std::string describe(const DataPoint &point)
{
  return "observable \"" + point.observable + "\", index " + std::to_string(point.index) +
         ", of experiment \"" + point.experiment + "\"";
}

void check_options(const StudyOptions &options)
{
  if (!(options.level > 0. && options.level < 0.5))
    throw UserError("The study's level must lie between 0 and 0.5: give the probability of a false "
                    "alarm that you accept, such as 0.05.");
  if (options.null_runs < 8 || options.screen_runs < 1 || options.validate_runs < 3)
    throw UserError("The study needs at least 8 runs for the stage null, 1 for screen and 3 for "
                    "validate: raise these numbers.");
}

void check_point(const MeasuredPoint &point, const std::vector<DataPoint> &known)
{
  if (std::find(known.begin(), known.end(), point.point) == known.end())
    throw UserError(
        "The measured data have a value for " + describe(point.point) +
        ", which its simulation does not give: see eunoe-discovery --list-observables.");
  if (!std::isfinite(point.value) || !std::isfinite(point.standard_deviation) ||
      point.standard_deviation < 0. || point.repeats == 0)
    throw UserError("The measured data for " + describe(point.point) +
                    " need a finite value, a standard deviation of at least 0, and at least one "
                    "repeat.");
}

} // namespace

StudyState::StudyState(const StudyOptions &options, const MeasuredData &data,
                       const std::vector<Factor> &factors, Simulator &simulator, Log &log)
    : options(options), data(data), archive(simulator, options.budget), log(log)
{
  check_options(options);
  for (const Factor &factor : factors) {
    if (factor.kind == Factor::Kind::effect)
      effects.push_back(factor);
    else if (factor.prior_deviation > 0.)
      nuisances.push_back(factor);
  }
  std::set<std::string> names;
  for (const Factor &factor : factors)
    if (!names.insert(factor.name).second)
      throw UserError("Two effects or nuisances are called \"" + factor.name +
                      "\": give each its own name.");
  if (effects.empty())
    throw UserError("The study has no effects to look for: name some, or \"all\".");
  if (data.fit.empty())
    throw UserError("The measured data have no cell for the fit: set the column \"use\" of some "
                    "to fit.");

  std::set<DataPoint> seen;
  for (const MeasuredPoint &point : data.fit) {
    if (!seen.insert(point.point).second)
      throw UserError("The measured data have two values for " + describe(point.point) + ".");
    if (std::find(experiments.begin(), experiments.end(), point.point.experiment) ==
        experiments.end())
      experiments.push_back(point.point.experiment);
  }
  for (const MeasuredPoint &point : data.held_out)
    check_point(point, simulator.data_points(point.point.experiment));
  for (const std::string &experiment : experiments)
    for (const DataPoint &point : simulator.data_points(experiment))
      columns.push_back(point);
  for (const MeasuredPoint &point : data.fit) {
    check_point(point, simulator.data_points(point.point.experiment));
    data_points.push_back(point.point);
  }
}

Eigen::VectorXd StudyState::measured(const Eigen::VectorXd &all) const
{
  Eigen::VectorXd result(static_cast<Eigen::Index>(column_of_point.size()));
  for (std::size_t c = 0; c < column_of_point.size(); ++c)
    result(static_cast<Eigen::Index>(c)) = all(column_of_point[c]);
  return result;
}

std::vector<RunRequest> StudyState::requests(const Amplitudes &amplitudes,
                                             const std::uint32_t seed) const
{
  std::vector<RunRequest> result;
  for (const std::string &experiment : experiments)
    result.push_back({experiment, amplitudes, seed});
  return result;
}

std::uint32_t StudyState::first_seed(const Amplitudes &amplitudes)
{
  const std::uint32_t start = 100000u * options.seed + 1u;
  if (options.common_random_numbers)
    return start;
  const auto number = static_cast<std::uint32_t>(seed_offsets.size());
  return start + 500u * seed_offsets.emplace(amplitudes, number).first->second;
}

void StudyState::run_design(const std::vector<DesignPoint> &design)
{
  // Two rounds: the second stands in for runs that failed in the first.
  for (unsigned int round = 0; round < 2; ++round) {
    struct Asked
    {
      const DesignPoint *at;
      std::uint32_t seed;
    };
    std::vector<Asked> asked;
    std::vector<RunRequest> all;
    std::uint64_t room = archive.remaining() / experiments.size();
    for (const DesignPoint &at : design) {
      const std::size_t there = replicates[at.amplitudes].size();
      for (std::size_t k = there; k < at.n_replicates && room > 0; ++k, --room) {
        const std::uint32_t seed = first_seed(at.amplitudes) + tried[at.amplitudes]++;
        asked.push_back({&at, seed});
        const auto runs = requests(at.amplitudes, seed);
        all.insert(all.end(), runs.begin(), runs.end());
      }
    }
    const std::vector<RunResult> results = archive.get(all);
    for (std::size_t k = 0; k < asked.size(); ++k) {
      Replicate replicate{
          asked[k].seed, Eigen::VectorXd(static_cast<Eigen::Index>(columns.size())), {}};
      Eigen::Index column = 0;
      bool complete = true;
      for (std::size_t e = 0; e < experiments.size(); ++e) {
        const RunResult &result = results[k * experiments.size() + e];
        complete = complete && result.has_value();
        for (std::size_t c = 0; complete && c < result->size(); ++c)
          replicate.values(column++) = (*result)[c];
      }
      if (!complete || !measured(replicate.values).allFinite())
        continue;
      if (modes.n_modes() > 0)
        replicate.modes = modes.reduce(measured(replicate.values));
      replicates[asked[k].at->amplitudes].push_back(replicate);
    }
    correlations.clear();
  }
}

void StudyState::set_modes(const Modes &chosen)
{
  modes = chosen;
  for (auto &[amplitudes, there] : replicates)
    for (Replicate &replicate : there)
      replicate.modes = modes.reduce(measured(replicate.values));
}

Eigen::VectorXd StudyState::tolerance() const
{
  return options.model_tolerance * value.cwiseAbs().cwiseQuotient(modes.deviations());
}

Eigen::MatrixXd StudyState::other_covariance(const DataNoise &data_noise,
                                             const Eigen::MatrixXd &run_covariance) const
{
  Eigen::MatrixXd result = data_noise.modes + nuisance_noise * run_covariance;
  if (nuisance_changes.cols() > 0) {
    const Eigen::MatrixXd changes = modes.basis() * nuisance_changes;
    result += changes * changes.transpose();
  }
  if (options.model_tolerance > 0.) {
    // Half of the forgiven variance is independent at each data point, half common to the
    // observable.
    const Eigen::VectorXd size = tolerance();
    for (const Modes::Group &group : modes.groups()) {
      Eigen::VectorXd part = Eigen::VectorXd::Zero(size.size());
      for (const Eigen::Index c : group.points)
        part(c) = size(c);
      const Eigen::VectorXd whole = modes.basis() * part;
      result += 0.5 * whole * whole.transpose();
    }
    result += 0.5 * modes.basis() * size.cwiseAbs2().asDiagonal() * modes.basis().transpose();
  }
  return result;
}

Amplitudes StudyState::amplitudes(const EffectSet &set, const Eigen::VectorXd &position) const
{
  Amplitudes result;
  for (std::size_t k = 0; k < set.size(); ++k) {
    const double u = position(static_cast<Eigen::Index>(k));
    const Factor &effect = effects[set[k]];
    if (u != 0.)
      result[effect.name] = effect.null_value + u * effect.scale;
  }
  return result;
}

double StudyState::seed_correlation(const EffectSet &active) const
{
  const auto known = correlations.find(active);
  return known != correlations.end() ? known->second
                                     : correlations[active] = estimate_correlation(active);
}

double StudyState::estimate_correlation(const EffectSet &active) const
{
  std::set<std::string> names;
  for (const std::size_t k : active)
    names.insert(effects[k].name);
  double products = 0., squares = 0., base_squares = 0., pairs = 0.;
  for (const auto &[amplitudes, there] : replicates) {
    std::set<std::string> here;
    for (const auto &[name, amplitude] : amplitudes)
      here.insert(name);
    if (here != names)
      continue;
    std::vector<Eigen::VectorXd> changed, unchanged;
    for (const Replicate &replicate : there)
      for (const Replicate &other : base())
        if (other.seed == replicate.seed) {
          changed.push_back(misfit.coordinates(replicate.modes));
          unchanged.push_back(misfit.coordinates(other.modes));
        }
    if (changed.size() < 2)
      continue;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(misfit.size()), base_mean = mean;
    for (std::size_t k = 0; k < changed.size(); ++k) {
      mean += changed[k] / static_cast<double>(changed.size());
      base_mean += unchanged[k] / static_cast<double>(changed.size());
    }
    for (std::size_t k = 0; k < changed.size(); ++k) {
      products += (changed[k] - mean).dot(unchanged[k] - base_mean);
      squares += (changed[k] - mean).squaredNorm();
      base_squares += (unchanged[k] - base_mean).squaredNorm();
    }
    pairs += static_cast<double>(changed.size() - 1);
  }
  if (pairs == 0. || squares <= 0. || base_squares <= 0.)
    return 0.;
  const double correlation = products / std::sqrt(squares * base_squares);
  const double error = 1. / std::sqrt(pairs * static_cast<double>(misfit.size()));
  return correlation > 3. * error ? std::min(correlation, 0.98) : 0.;
}

std::vector<Emulator::Run> StudyState::runs_of(
    const EffectSet &set, const std::function<Eigen::VectorXd(const Replicate &)> &values) const
{
  std::vector<Emulator::Run> result;
  Eigen::VectorXd base_mean;
  std::map<std::uint32_t, Eigen::VectorXd> base_of_seed;
  for (const Replicate &run : base()) {
    base_of_seed[run.seed] = values(run);
    base_mean = result.empty() ? base_of_seed[run.seed] : base_mean + base_of_seed[run.seed];
    result.push_back(
        {Eigen::VectorXd::Zero(static_cast<Eigen::Index>(set.size())), base_of_seed[run.seed], 1.});
  }
  base_mean /= static_cast<double>(result.size());

  for (const auto &[amplitudes, there] : replicates) {
    if (amplitudes.empty())
      continue;
    Eigen::VectorXd position = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(set.size()));
    EffectSet active;
    for (std::size_t k = 0; k < set.size(); ++k) {
      const Factor &effect = effects[set[k]];
      const auto found = amplitudes.find(effect.name);
      if (found == amplitudes.end())
        continue;
      position(static_cast<Eigen::Index>(k)) = (found->second - effect.null_value) / effect.scale;
      active.push_back(set[k]);
    }
    if (active.size() != amplitudes.size())
      continue;
    const double correlation = options.common_random_numbers ? seed_correlation(active) : 0.;
    for (const Replicate &run : there) {
      Emulator::Run row{position, values(run), 1.};
      const auto same = base_of_seed.find(run.seed);
      if (correlation > 0. && same != base_of_seed.end()) {
        row.values -= correlation * (same->second - base_mean);
        row.variance = 1. - correlation * correlation;
      }
      result.push_back(row);
    }
  }
  return result;
}

Slopes StudyState::slopes(const EffectSet &set) const
{
  constexpr double least = 1e-3, clear = 3.;
  Eigen::VectorXd base_mean = Eigen::VectorXd::Zero(modes.n_modes());
  for (const Replicate &run : base())
    base_mean += run.modes / static_cast<double>(base().size());
  const auto mean_square = [&](const Eigen::VectorXd &slope) {
    return misfit.coordinates(slope).squaredNorm() / static_cast<double>(misfit.size());
  };
  Slopes result;
  result.overall = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(set.size()), least);
  result.steepest = result.overall;
  for (std::size_t k = 0; k < set.size(); ++k) {
    const Factor &effect = effects[set[k]];
    double &overall = result.overall(static_cast<Eigen::Index>(k)), steepest = least;
    Eigen::VectorXd products = Eigen::VectorXd::Zero(modes.n_modes());
    double squares = 0.;
    for (const auto &[amplitudes, there] : replicates) {
      if (amplitudes.size() != 1 || amplitudes.begin()->first != effect.name || there.empty())
        continue;
      const double u = (amplitudes.begin()->second - effect.null_value) / effect.scale;
      const auto number = static_cast<double>(there.size());
      Eigen::VectorXd change = Eigen::VectorXd::Zero(modes.n_modes());
      for (const Replicate &run : there)
        change += (run.modes - base_mean) / number;
      products += number * u * change;
      squares += number * u * u;
      const double noise = (1. / number + 1. / static_cast<double>(base().size())) / (u * u);
      const double square = mean_square(change / u) - noise;
      if (square > clear * noise * std::sqrt(2. / static_cast<double>(misfit.size())))
        steepest = std::max(steepest, square);
    }
    if (squares > 0.)
      overall = std::max(least, mean_square(products / squares) - 1. / squares);
    result.steepest(static_cast<Eigen::Index>(k)) = std::max(overall, steepest);
  }
  return result;
}

Emulator StudyState::emulator_of_modes(const EffectSet &set) const
{
  return Emulator(runs_of(set, [](const Replicate &run) { return run.modes; }), slopes(set));
}

Emulator StudyState::emulator_of_columns(const EffectSet &set) const
{
  return Emulator(runs_of(set, [](const Replicate &run) { return run.values; }), slopes(set));
}

std::string name_of(const StudyState &study, const EffectSet &set)
{
  std::string name;
  for (const std::size_t k : set)
    name += (name.empty() ? "" : " + ") + study.effects[k].name;
  return name;
}

} // namespace eunoe::discovery
