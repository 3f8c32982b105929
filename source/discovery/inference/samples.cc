#include <eunoe/discovery/inference/samples.h>
#include <eunoe/discovery/tuned.h>

#include <algorithm>
#include <limits>

namespace eunoe::discovery {

namespace {

/// What a position of one stands for.
double unit_of(const Factor &factor)
{
  return factor.kind == Factor::Kind::effect ? factor.scale : factor.prior_deviation;
}

/// In units. Amplitudes are told apart, and kept, with six digits.
double rounded(const double value, const double unit)
{
  constexpr double all_digits = 1e6;
  return std::round(value / unit * all_digits) / all_digits;
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

FactorSpace::FactorSpace(const std::vector<Factor> &factors) : all(factors)
{
  const auto end = std::stable_partition(all.begin(), all.end(), [](const Factor &factor) {
    return factor.kind == Factor::Kind::effect;
  });
  effects = static_cast<std::size_t>(end - all.begin());
}

double FactorSpace::lower(const std::size_t k) const
{
  const Factor &f = effect(k);
  return f.sign == Factor::Sign::above ? 0. : std::min(0., (f.lower - f.null_value) / f.scale);
}

double FactorSpace::upper(const std::size_t k) const
{
  const Factor &f = effect(k);
  return f.sign == Factor::Sign::below ? 0. : std::max(0., (f.upper - f.null_value) / f.scale);
}

Amplitudes FactorSpace::amplitudes(const Eigen::VectorXd &position) const
{
  Amplitudes result;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Factor &f = all[k];
    const double u = position(static_cast<Eigen::Index>(k)), unit = unit_of(f);
    if (u != 0.)
      result[f.name] = f.null_value + rounded(u * unit, unit) * unit;
  }
  return result;
}

std::optional<Eigen::VectorXd> FactorSpace::position(const Amplitudes &amplitudes) const
{
  Eigen::VectorXd result = origin();
  std::size_t found = 0;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (const auto a = amplitudes.find(all[k].name); a != amplitudes.end()) {
      ++found;
      result(static_cast<Eigen::Index>(k)) =
          rounded(a->second - all[k].null_value, unit_of(all[k]));
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
  using tuned::runs::nuisance_step;
  std::vector<DesignPoint> points = {{space.origin(), at_origin}};
  for (std::size_t q = 0; q < space.n_nuisances(); ++q)
    for (const double side : {-nuisance_step, nuisance_step}) {
      points.push_back({space.origin(), on_each_side});
      points.back().position(static_cast<Eigen::Index>(space.n_effects() + q)) = side;
    }
  return points;
}

Samples::Samples(const StudyOptions &options, const FactorSpace &space, Simulator &simulator,
                 const std::vector<std::string> &experiments)
    : options(options), factors(space), source(simulator), next_seed(100000 * options.seed + 1)
{
  for (const std::string &experiment : experiments) {
    samples[experiment];
    failures[experiment];
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
  const Eigen::VectorXd position = *factors.position(request.amplitudes);
  if (!result || result->size() != source.data_points(request.experiment).size()) {
    ++failed;
    failures.at(request.experiment).push_back({position, {}});
    return;
  }
  samples.at(request.experiment)
      .push_back({position, Eigen::Map<const Eigen::VectorXd>(
                                result->data(), static_cast<Eigen::Index>(result->size()))});
}

unsigned int Samples::n_missing(const DesignPoint &point, const std::string &experiment) const
{
  if (!source.concerns(experiment, effects_of(factors, point.position)))
    return 0;
  const auto found = counts.find({experiment, factors.amplitudes(point.position)});
  return point.replicates - (found == counts.end() ? 0 : std::min(point.replicates, found->second));
}

std::size_t Samples::n_near(const std::vector<Sample> &runs, const std::size_t effect,
                            const std::optional<double> amplitude) const
{
  const std::vector<std::string> alone = {factors.effect(effect).name};
  const auto k = static_cast<Eigen::Index>(effect);
  return static_cast<std::size_t>(std::count_if(runs.begin(), runs.end(), [&](const Sample &run) {
    return effects_of(factors, run.position) == alone &&
           (!amplitude || std::abs(run.position(k) / *amplitude - 1.) < tuned::runs::near);
  }));
}

bool Samples::has_failed(const std::size_t effect,
                         const std::vector<std::string> &experiments) const
{
  return std::any_of(experiments.begin(), experiments.end(), [&](const std::string &experiment) {
    return n_near(failures.at(experiment), effect, std::nullopt) > 0;
  });
}

bool Samples::has_near(const std::size_t effect, const std::optional<double> amplitude,
                       const unsigned int runs, const std::vector<std::string> &experiments) const
{
  return std::all_of(experiments.begin(), experiments.end(), [&](const std::string &experiment) {
    return !source.concerns(experiment, {factors.effect(effect).name}) ||
           n_near(samples.at(experiment), effect, amplitude) >= runs;
  });
}

bool Samples::fails_near(const std::size_t effect, const double amplitude,
                         const std::vector<std::string> &experiments) const
{
  return std::any_of(experiments.begin(), experiments.end(), [&](const std::string &experiment) {
    return n_near(failures.at(experiment), effect, amplitude) >= tuned::runs::too_many_failures &&
           n_near(samples.at(experiment), effect, amplitude) == 0;
  });
}

std::uint64_t Samples::remaining() const
{
  if (options.budget == 0)
    return std::numeric_limits<std::uint64_t>::max();
  return asked + reserved < options.budget ? options.budget - asked - reserved : 0;
}

void Samples::run(const std::vector<DesignPoint> &points,
                  const std::vector<std::string> &experiments, const bool only_missing,
                  const std::vector<unsigned int> &turns)
{
  const std::uint64_t room = remaining();
  std::vector<RunRequest> wanted;
  // Equal turns keep the order of the points.
  std::multimap<std::pair<unsigned int, unsigned int>, std::size_t> in_turns;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const DesignPoint &point = points[k];
    const Amplitudes amplitudes = factors.amplitudes(point.position);
    const std::vector<std::string> effects = effects_of(factors, point.position);
    for (unsigned int r = 0; r < point.replicates; ++r) {
      const std::size_t before = wanted.size();
      for (const std::string &experiment : experiments)
        if ((wanted.size() < room || !turns.empty()) &&
            (only_missing ? r < n_missing(point, experiment)
                          : source.concerns(experiment, effects)))
        {
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
