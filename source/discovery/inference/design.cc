#include <eunoe/core/problems.h>
#include <eunoe/discovery/inference/design.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// In standard deviations of a run (Mahalanobis).
double strength(const Target &target, const std::size_t effect, const double amplitude)
{
  const Target::Prediction with = target.predict({{effect, amplitude}}),
                           without = target.predict({});
  return std::sqrt(std::max(0., (with.mean - without.mean).squaredNorm() -
                                    tuned::runs::error_taken_off * with.leverage.sum()));
}

/// Error of an emulator, as a share of the deviation of what is measured.
double unknown(const Target &target, const Target::Prediction &prediction)
{
  return std::sqrt(target.unknown_share(prediction));
}

} // namespace

Design::Design(const StudyOptions &options, const FactorSpace &space, Samples &samples,
               std::vector<std::string> experiments)
    : options(options), space(space), samples(samples), experiments(std::move(experiments)),
      random(options.seed, 23)
{
}

Eigen::VectorXd Design::draw_nuisances()
{
  using tuned::runs::most_nuisance;
  Eigen::VectorXd position = space.origin();
  for (std::size_t q = 0; q < space.n_nuisances(); ++q) {
    constexpr double digits = 1e3;
    position(static_cast<Eigen::Index>(space.n_effects() + q)) =
        std::round(std::clamp(random.normal(), -most_nuisance, most_nuisance) * digits) / digits;
  }
  return position;
}

DesignPoint Design::point(const std::size_t effect, const double amplitude)
{
  // Three digits are enough, and make rows of the table that can be read.
  const double unit = std::pow(10., std::floor(std::log10(std::abs(amplitude))) - 2.);
  Eigen::VectorXd position = draw_nuisances();
  position(static_cast<Eigen::Index>(effect)) =
      std::clamp(std::round(amplitude / unit) * unit, space.lower(effect), space.upper(effect));
  return {position, tuned::runs::replicates};
}

void Design::run_base()
{
  const std::uint64_t needed = options.null_runs * experiments.size();
  if (samples.n_known() == 0 && samples.remaining() < needed)
    throw UserError("The budget of " + std::to_string(options.budget) +
                    " runs has no room for the " + std::to_string(needed) +
                    " first runs of the base model. Increase 'budget of runs'.");
  samples.complete(points_of_base(space, options.null_runs, options.nuisance_runs), experiments);
}

void Design::run_effects(const std::function<Target()> &estimate)
{
  std::vector<std::pair<std::size_t, double>> open, ends; // effects and amplitudes
  for (std::size_t k = 0; k < space.n_effects(); ++k)
    for (const double limit : {space.lower(k), space.upper(k)})
      if (limit != 0.) {
        const double side = limit < 0. ? -1. : 1.;
        open.emplace_back(k, std::min(1., std::abs(limit)) * side);
        // An emulator knows little of amplitudes beyond the last that was run.
        if (std::abs(limit) > 1.)
          ends.emplace_back(k, limit);
      }
  for (int level = 0; level < tuned::runs::most_amplitudes && !open.empty(); ++level) {
    std::vector<DesignPoint> points;
    // The ends of all ranges come first, and all effects in turns, so that a budget that ends, or a
    // table that is stopped, within this look has something of each.
    std::vector<unsigned int> turns;
    auto looks = open;
    if (level == 0)
      looks.insert(looks.end(), ends.begin(), ends.end());
    for (const auto &[effect, amplitude] : looks)
      if (!samples.has_near(effect, amplitude, tuned::runs::replicates, experiments) &&
          !samples.fails_near(effect, amplitude, experiments))
      {
        points.push_back(point(effect, amplitude));
        const bool is_end = amplitude == space.lower(effect) || amplitude == space.upper(effect);
        turns.push_back(is_end ? 0 : 1);
      }
    samples.run(points, experiments, turns);
    const Target target = estimate();
    decltype(open) still;
    for (const auto &[effect, amplitude] : open)
      if (strength(target, effect, amplitude) > tuned::runs::just_visible)
        still.emplace_back(effect, amplitude * tuned::runs::amplitude_ratio);
    open = still;
  }
}

bool Design::refine(const Evidence &evidence, const Findings &findings)
{
  const Target &target = evidence.target();
  // Whether a model becomes the likeliest once it is known better.
  std::vector<Wish> list;
  std::vector<double> logs;
  for (const std::size_t k : evidence.usable()) {
    const std::vector<double> optimistic = evidence.optimistic(k);
    for (std::size_t i = 0; i < optimistic.size(); ++i) {
      const Evidence::Place &place = evidence.places(k)[i];
      list.push_back({k, place.amplitude, unknown(target, place.hypothesis.prediction)});
      logs.push_back(optimistic[i]);
    }
  }
  // Something is detected by the evidence of single effects. Before that, the many pairs, each of
  // which may hope for a little, would only take runs from these.
  for (const Model &model : findings.models)
    if (findings.detected && model.effects.size() == 2) {
      const double hope = evidence.optimistic_pair(model);
      for (const auto &[k, amplitude] : model.best) {
        list.push_back({k, amplitude, unknown(target, target.predict({{k, amplitude}}))});
        logs.push_back(hope);
      }
    }
  for (double &value : logs)
    value /= tuned::runs::temperature_of_hopes;
  const std::vector<double> shares = shares_of(std::move(logs));
  for (std::size_t i = 0; i < list.size(); ++i)
    list[i].weight *= shares[i];
  std::stable_sort(list.begin(), list.end(), [](const Wish &a, const Wish &b) {
    return std::pair(a.effect, a.amplitude) < std::pair(b.effect, b.amplitude);
  });
  // What a table knows already does not make a study's own rounds larger.
  return run(std::move(list), size_of_round(samples.n_asked()));
}

std::uint64_t Design::size_of_round(const std::uint64_t n_runs) const
{
  return std::max(tuned::runs::fewest_points,
                  n_runs / tuned::runs::one_in / experiments.size() / tuned::runs::replicates);
}

bool Design::run(std::vector<Wish> list, const std::uint64_t n_points)
{
  using tuned::runs::share_of_base;
  list.erase(std::remove_if(list.begin(), list.end(),
                            [&](const Wish &wish) {
                              return samples.fails_near(wish.effect, wish.amplitude, experiments);
                            }),
             list.end());
  double others = 0.;
  for (const Wish &wish : list)
    others += wish.weight;
  const double of_base = others > 0. ? others * share_of_base / (1. - share_of_base) : 1.;
  list.push_back({space.n_effects(), 0., of_base});
  const double sum = others + of_base;
  // Systematic sampling: as many points of each as it has of the weight.
  std::vector<DesignPoint> points;
  double below = 0.;
  for (const Wish &wish : list) {
    below += wish.weight / sum * static_cast<double>(n_points);
    while (static_cast<double>(points.size()) + 0.5 <= below)
      if (wish.effect < space.n_effects())
        points.push_back(point(wish.effect, wish.amplitude));
      else
        points.push_back(
            {points.size() % 2 == 0 ? space.origin() : draw_nuisances(), tuned::runs::replicates});
  }
  const std::uint64_t before = samples.n_asked();
  samples.run(points, experiments);
  return samples.n_asked() > before;
}

bool Design::sharpen(const Evidence &evidence, const std::vector<Model> &answer)
{
  // The end of an interval depends on what lies beyond it.
  const Target &target = evidence.target();
  std::vector<Wish> list;
  std::vector<double> logs;
  for (const Model &model : answer)
    for (const auto &[k, best] : model.best)
      for (const Evidence::Place &place : evidence.places(k)) {
        EffectPositions effects = model.best;
        effects[k] = place.amplitude;
        const Target::Prediction prediction = target.predict(effects);
        list.push_back({k, place.amplitude, unknown(target, prediction)});
        logs.push_back(evidence.log_optimistic(evidence.prepare(prediction)) /
                       tuned::runs::temperature_of_amplitudes);
      }
  const std::vector<double> shares = shares_of(std::move(logs));
  double variance = 0.;
  for (std::size_t i = 0; i < list.size(); ++i) {
    variance += shares[i] * list[i].weight * list[i].weight;
    list[i].weight *= shares[i];
  }
  return variance > tuned::runs::known_amplitude &&
         run(std::move(list), tuned::runs::fewest_points);
}

bool Design::fill(const Evidence &evidence)
{
  std::vector<Wish> list;
  for (const std::size_t k : evidence.usable())
    for (const Evidence::Place &place : evidence.places(k))
      list.push_back({k, place.amplitude, unknown(evidence.target(), place.hypothesis.prediction)});
  return run(std::move(list), size_of_round(samples.n_known() + samples.n_asked()));
}

} // namespace eunoe::discovery
