#include <eunoe/discovery/inference/samples.h>

#include <algorithm>
#include <limits>

namespace eunoe::discovery {

namespace {

constexpr double all_digits = 1e6;

/// Amplitudes are told apart, and kept, with six digits.
double rounded(const double value, const double unit)
{
  return std::round(value / unit * all_digits) / all_digits * unit;
}

std::vector<std::string> effects_of(const FactorSpace &space, const Eigen::VectorXd &position)
{
  std::vector<std::string> names;
  for (std::size_t k = 0; k < space.n_effects(); ++k)
    if (position(static_cast<Eigen::Index>(k)) != 0.)
      names.push_back(space.effect(k).name);
  return names;
}

} // namespace

FactorSpace::FactorSpace(const std::vector<Factor> &factors)
{
  for (const Factor &factor : factors)
    (factor.kind == Factor::Kind::effect ? effects : nuisances).push_back(factor);
}

double FactorSpace::lower(const std::size_t k) const
{
  const Factor &f = effects[k];
  return f.sign == Factor::Sign::above ? 0. : std::min(0., (f.lower - f.null_value) / f.scale);
}

double FactorSpace::upper(const std::size_t k) const
{
  const Factor &f = effects[k];
  return f.sign == Factor::Sign::below ? 0. : std::max(0., (f.upper - f.null_value) / f.scale);
}

Amplitudes FactorSpace::amplitudes(const Eigen::VectorXd &position) const
{
  Amplitudes result;
  for (Eigen::Index k = 0; k < position.size(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const bool is_effect = i < n_effects();
    const Factor &f = is_effect ? effects[i] : nuisances[i - n_effects()];
    const double unit = is_effect ? f.scale : f.prior_deviation;
    if (position(k) != 0.)
      result[f.name] = f.null_value + rounded(position(k) * unit, unit);
  }
  return result;
}

std::optional<Eigen::VectorXd> FactorSpace::position(const Amplitudes &amplitudes) const
{
  Eigen::VectorXd result = origin();
  std::size_t found = 0;
  for (std::size_t k = 0; k < n_effects() + n_nuisances(); ++k) {
    const bool is_effect = k < n_effects();
    const Factor &f = is_effect ? effects[k] : nuisances[k - n_effects()];
    const auto a = amplitudes.find(f.name);
    if (a == amplitudes.end())
      continue;
    ++found;
    const double unit = is_effect ? f.scale : f.prior_deviation;
    result(static_cast<Eigen::Index>(k)) =
        std::round((a->second - f.null_value) / unit * all_digits) / all_digits;
  }
  return found == amplitudes.size() ? std::make_optional(result) : std::nullopt;
}

Eigen::MatrixXd runs_of_base(const std::vector<Sample> &samples,
                             const std::vector<Eigen::Index> &columns)
{
  std::vector<const Sample *> base;
  for (const Sample &sample : samples)
    if (sample.position.isZero(0.))
      base.push_back(&sample);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(base.size()),
                       static_cast<Eigen::Index>(columns.size()));
  for (std::size_t r = 0; r < base.size(); ++r)
    rows.row(static_cast<Eigen::Index>(r)) = base[r]->values(columns).transpose();
  return rows;
}

std::vector<DesignPoint> points_of_base(const FactorSpace &space, const unsigned int at_origin,
                                        const unsigned int on_each_side)
{
  constexpr double step = 2.;
  std::vector<DesignPoint> points = {{space.origin(), at_origin}};
  for (std::size_t q = 0; q < space.n_nuisances(); ++q)
    for (const double side : {-step, step}) {
      points.push_back({space.origin(), on_each_side});
      points.back().position(static_cast<Eigen::Index>(space.n_effects() + q)) = side;
    }
  return points;
}

Samples::Samples(const StudyOptions &options, const FactorSpace &space, Simulator &simulator,
                 const std::vector<std::string> &experiments)
    : options(options), space(space), source(simulator), next_seed(100000 * options.seed + 1)
{
  for (const std::string &experiment : experiments) {
    samples[experiment];
    // A table has them in the order in which they were finished, which is partly chance.
    auto all = simulator.known(experiment);
    std::stable_sort(all.begin(), all.end(),
                     [](const auto &a, const auto &b) { return a.first.seed < b.first.seed; });
    for (const auto &[request, result] : all) {
      if (!space.position(request.amplitudes))
        continue;
      add(request, result);
      ++known;
      next_seed = std::max(next_seed, request.seed + 1);
    }
  }
  failed = 0;
}

void Samples::add(const RunRequest &request, const RunResult &result)
{
  ++counts[{request.experiment, request.amplitudes}];
  const Eigen::VectorXd position = *space.position(request.amplitudes);
  if (!result || result->size() != source.data_points(request.experiment).size()) {
    ++failed;
    failures[request.experiment].push_back(position);
    return;
  }
  samples.at(request.experiment)
      .push_back({position, Eigen::Map<const Eigen::VectorXd>(
                                result->data(), static_cast<Eigen::Index>(result->size()))});
}

unsigned int Samples::n_missing(const DesignPoint &point, const std::string &experiment) const
{
  if (!source.concerns(experiment, effects_of(space, point.position)))
    return 0;
  const auto found = counts.find({experiment, space.amplitudes(point.position)});
  return point.replicates - (found == counts.end() ? 0 : std::min(point.replicates, found->second));
}

bool Samples::has_any(const std::size_t effect, const std::vector<std::string> &experiments) const
{
  const std::vector<std::string> alone = {space.effect(effect).name};
  return std::all_of(experiments.begin(), experiments.end(), [&](const std::string &experiment) {
    const std::vector<Sample> &all = samples.at(experiment);
    return !source.concerns(experiment, alone) ||
           std::any_of(all.begin(), all.end(), [&](const Sample &sample) {
             return effects_of(space, sample.position) == alone;
           });
  });
}

bool Samples::has_failed(const std::size_t effect,
                         const std::vector<std::string> &experiments) const
{
  const std::vector<std::string> alone = {space.effect(effect).name};
  return std::any_of(experiments.begin(), experiments.end(), [&](const std::string &experiment) {
    const auto found = failures.find(experiment);
    return found != failures.end() && std::any_of(found->second.begin(), found->second.end(),
                                                  [&](const Eigen::VectorXd &position) {
                                                    return effects_of(space, position) == alone;
                                                  });
  });
}

bool Samples::is_near(const Eigen::VectorXd &position, const std::size_t effect,
                      const double amplitude) const
{
  constexpr double near = 0.2;
  return effects_of(space, position) == std::vector<std::string>{space.effect(effect).name} &&
         std::abs(position(static_cast<Eigen::Index>(effect)) / amplitude - 1.) < near;
}

std::size_t Samples::n_near(const std::string &experiment, const std::size_t effect,
                            const double amplitude) const
{
  const std::vector<Sample> &all = samples.at(experiment);
  return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](const Sample &sample) {
    return is_near(sample.position, effect, amplitude);
  }));
}

bool Samples::has_near(const std::size_t effect, const double amplitude, const unsigned int runs,
                       const std::vector<std::string> &experiments) const
{
  return std::all_of(experiments.begin(), experiments.end(), [&](const std::string &experiment) {
    return !source.concerns(experiment, {space.effect(effect).name}) ||
           n_near(experiment, effect, amplitude) >= runs;
  });
}

bool Samples::fails_near(const std::size_t effect, const double amplitude,
                         const std::vector<std::string> &experiments) const
{
  // One may have failed by chance.
  constexpr std::ptrdiff_t too_many = 2;
  return std::any_of(experiments.begin(), experiments.end(), [&](const std::string &experiment) {
    const auto found = failures.find(experiment);
    return found != failures.end() &&
           std::count_if(found->second.begin(), found->second.end(),
                         [&](const Eigen::VectorXd &position) {
                           return is_near(position, effect, amplitude);
                         }) >= too_many &&
           n_near(experiment, effect, amplitude) == 0;
  });
}

std::uint64_t Samples::remaining() const
{
  if (options.budget == 0)
    return std::numeric_limits<std::uint64_t>::max();
  return asked + reserved < options.budget ? options.budget - asked - reserved : 0;
}

void Samples::run(const std::vector<DesignPoint> &points,
                  const std::vector<std::string> &experiments,
                  const std::vector<unsigned int> &turns)
{
  const Number number = [&](const DesignPoint &point, const std::string &experiment) {
    return source.concerns(experiment, effects_of(space, point.position)) ? point.replicates : 0;
  };
  run(points, experiments, number, turns);
}

void Samples::complete(const std::vector<DesignPoint> &points,
                       const std::vector<std::string> &experiments)
{
  run(points, experiments, [&](const DesignPoint &point, const std::string &experiment) {
    return n_missing(point, experiment);
  });
}

void Samples::run(const std::vector<DesignPoint> &points,
                  const std::vector<std::string> &experiments, const Number &number,
                  const std::vector<unsigned int> &turns)
{
  const std::uint64_t room = remaining();
  std::vector<RunRequest> wanted;
  // Equal turns keep the order of the points.
  std::multimap<std::pair<unsigned int, unsigned int>, std::size_t> in_turns;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const DesignPoint &point = points[k];
    const Amplitudes amplitudes = space.amplitudes(point.position);
    for (unsigned int r = 0; r < point.replicates; ++r) {
      const std::size_t before = wanted.size();
      for (const std::string &experiment : experiments)
        if ((wanted.size() < room || !turns.empty()) && r < number(point, experiment)) {
          in_turns.emplace(turns.empty() ? std::pair(0u, 0u) : std::pair(turns[k], r),
                           wanted.size());
          wanted.push_back({experiment, amplitudes, next_seed});
        }
      next_seed += wanted.size() > before ? 1 : 0;
    }
  }
  std::vector<RunRequest> requests;
  std::vector<std::size_t> places;
  for (const auto &[turn, place] : in_turns)
    if (requests.size() < room) {
      requests.push_back(wanted[place]);
      places.push_back(place);
    }
  asked += requests.size();
  const std::vector<RunResult> results = source.run(requests);
  // Samples stand in the order of their seeds, in whatever order they were run: twins draw from
  // them by their places.
  std::map<std::size_t, RunResult> by_place;
  for (std::size_t k = 0; k < results.size(); ++k)
    by_place[places[k]] = results[k];
  for (const auto &[place, result] : by_place)
    add(wanted[place], result);
}

} // namespace eunoe::discovery
