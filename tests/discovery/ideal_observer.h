#ifndef eunoe_tests_discovery_ideal_observer_h
#define eunoe_tests_discovery_ideal_observer_h

// The ceiling of detection and naming: an observer who knows the fingerprint and the scatter of
// every effect at every amplitude exactly, and the noise of the instrument, but neither amplitudes
// nor nuisances. No study can detect or name more effects rightly. Of two effects he thinks with
// the same prior as a study.

#include <eunoe/discovery/inference/evidence.h>

#include "recorded.h"
#include <boost/math/distributions/chi_squared.hpp>

namespace test {

class IdealObserver
{
public:
  /// @param instrument noise of a repeat at each data point, as a share of a run's scatter
  /// @param unknown effects that he knows nothing of
  IdealObserver(const RecordedSimulator &simulator, const std::vector<MeasuredPoint> &data,
                unsigned int repeats, double instrument,
                const std::vector<std::string> &unknown = {})
      : simulator(simulator), repeats(repeats), instrument(instrument)
  {
    for (const MeasuredPoint &point : data) {
      Eigen::VectorXd &part = parts[point.point.experiment];
      part.conservativeResize(part.size() + 1);
      part(part.size() - 1) = point.value;
    }
    covariance_of_nuisances();
    for (const Factor &f : simulator.factors())
      if (f.kind == Factor::Kind::effect && std::count(unknown.begin(), unknown.end(), f.name) == 0)
      {
        find_places(f);
        effects.emplace_back(log_evidence(f), f.name);
      }
  }

  using Names = std::set<std::string>;

  /// Which effects a study would name that knew as much: one or two, of the models that together
  /// have a probability. Without those that have one effect more than a likelier model; one model
  /// is a name, more are a tie. The first is the likeliest of all.
  std::vector<Names> models(const double probability) const
  {
    const Prior prior;
    const auto n = static_cast<double>(effects.size());
    std::vector<std::pair<double, Names>> all;
    for (const auto &[log, name] : effects)
      all.emplace_back(std::log(prior.one_effect / n) + log, Names{name});
    for (const auto &[names, log] : log_evidence_of_pairs())
      all.emplace_back(std::log(prior.two_effects / (0.5 * n * (n - 1.))) + log, names);
    return likeliest(all, probability);
  }

  /// Probability that data of a model with one or two effects lie as far from it as these do from
  /// its best amplitudes.
  double p_of_fit(const Names &model) const
  {
    const auto &first = places.at(*model.begin()), &second = places.at(*model.rbegin());
    double least = 1e300;
    for (const Place &p : first)
      if (model.size() == 1)
        least = std::min(least, distance(p.amplitude));
      else
        for (const Place &q : second) {
          Amplitudes both = p.amplitude;
          both.insert(q.amplitude.begin(), q.amplitude.end());
          least = std::min(least, distance(both));
        }
    const auto freedom = static_cast<double>(size()) - static_cast<double>(model.size());
    return boost::math::cdf(
        boost::math::complement(boost::math::chi_squared_distribution<>(freedom), least));
  }

  /// The likeliest single effects, which together have a probability; the likeliest first.
  std::vector<Names> single_effects(const double probability) const
  {
    std::vector<std::pair<double, Names>> all;
    for (const auto &[log, name] : effects)
      all.emplace_back(log, Names{name});
    return likeliest(all, probability);
  }

  /// Log of the evidence for some effect, each as likely as the others, over that for nothing.
  double log_bayes_factor() const
  {
    std::vector<double> logs;
    for (const auto &[log, name] : effects)
      logs.push_back(log);
    return log_sum(logs) - std::log(static_cast<double>(logs.size())) - log_likelihood({});
  }

private:
  static std::vector<Names> likeliest(std::vector<std::pair<double, Names>> all,
                                      const double probability)
  {
    std::sort(all.rbegin(), all.rend());
    std::vector<double> logs;
    for (const auto &[log, names] : all)
      logs.push_back(log);
    const double total = log_sum(logs);
    double sum = 0.;
    std::vector<Names> result;
    for (auto it = all.begin(); it != all.end() && sum < probability; ++it) {
      sum += std::exp(it->first - total);
      if (std::none_of(result.begin(), result.end(), [&](const Names &likelier) {
            return std::includes(it->second.begin(), it->second.end(), likelier.begin(),
                                 likelier.end());
          }))
        result.push_back(it->second);
    }
    return result;
  }

  /// An effect at one strength, and its change in units in which the covariance of the base model's
  /// data is the unit matrix.
  struct Place
  {
    double strength = 0., side = 1., strongest = 0.;
    Amplitudes amplitude;
    Eigen::VectorXd change;
  };

  static constexpr double just_visible = 1.;
  static constexpr int n_places = 30; ///< on each side of an effect's null value

  std::vector<std::string> experiments() const
  {
    std::vector<std::string> names;
    for (const auto &[name, part] : parts)
      names.push_back(name);
    return names;
  }

  /// Strengths in a geometric sequence, from the smallest that can be seen to that of the end of
  /// the range.
  void find_places(const Factor &f)
  {
    constexpr double strongest = 50.;
    for (const double limit : {f.lower, f.upper}) {
      const double side = limit < f.null_value ? -1. : 1.;
      if (limit == f.null_value ||
          f.sign == (side > 0. ? Factor::Sign::below : Factor::Sign::above))
        continue;
      const double last = std::min(strongest, simulator.strength({{f.name, limit}}, experiments()));
      for (int k = 0; k < n_places && just_visible < last; ++k) {
        Place place{
            just_visible * std::pow(last / just_visible, k / (n_places - 1.)), side, last, {}, {}};
        place.amplitude = amplitude(f.name, place, 0.);
        place.change = base.matrixL().solve(mean(place.amplitude) - mean({}));
        places[f.name].push_back(place);
      }
    }
  }

  /// The amplitude whose strength is e^shift times that of a place.
  Amplitudes amplitude(const std::string &name, const Place &place, const double shift) const
  {
    return {{name, simulator.amplitude_of(name, place.strength * std::exp(shift), experiments(),
                                          place.side)}};
  }

  /// Log of the mean likelihood over the places.
  double log_evidence(const Factor &f) const
  {
    std::vector<double> logs;
    if (const auto found = places.find(f.name); found != places.end())
      for (const Place &place : found->second)
        logs.push_back(log_likelihood(place.amplitude));
    return logs.empty() ? -1e300 : log_sum(logs) - std::log(static_cast<double>(logs.size()));
  }

  /// Pairs that can matter: first with the scatter of the base model at all places, then, around
  /// the best of them, with the right one (Laplace).
  std::map<Names, double> log_evidence_of_pairs() const
  {
    constexpr double matters = 25.;
    struct Rough
    {
      double least = 1e300;
      const Place *a = nullptr, *b = nullptr;
    };
    const Eigen::VectorXd deviation = base.matrixL().solve(data() - mean({}));
    std::map<Names, Rough> all;
    double least = 1e300;
    for (auto first = places.begin(); first != places.end(); ++first)
      for (auto second = places.begin(); second != first; ++second) {
        Rough &rough = all[{first->first, second->first}];
        for (const Place &p : first->second)
          for (const Place &q : second->second)
            if (const double distance = (deviation - p.change - q.change).squaredNorm();
                distance < rough.least)
              rough = {distance, &p, &q};
        least = std::min(least, rough.least);
      }
    std::map<Names, double> result;
    for (const auto &[names, rough] : all)
      if (0.5 * (rough.least - least) < matters)
        result[names] = laplace(rough.a->amplitude.begin()->first, *rough.a,
                                rough.b->amplitude.begin()->first, *rough.b);
    return result;
  }

  /// Log evidence of a pair, from the curvature of its likelihood in the logarithms of strengths,
  /// whose prior is uniform.
  double laplace(const std::string &a, const Place &p, const std::string &b, const Place &q) const
  {
    constexpr double step = 0.05, longest = 0.3;
    constexpr int iterations = 4;
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    const auto f = [&](const double x, const double y) {
      Amplitudes both = amplitude(a, p, at(0) + x);
      both.merge(amplitude(b, q, at(1) + y));
      return log_likelihood(both);
    };
    double value = 0., determinant = 0.;
    for (int i = 0; i <= iterations; ++i) {
      value = f(0., 0.);
      const double left = f(-step, 0.), right = f(step, 0.), down = f(0., -step), up = f(0., step);
      const double cross =
          (f(step, step) + f(-step, -step) + 2. * value - left - right - down - up) /
          (2. * step * step);
      Eigen::Matrix2d curvature;
      curvature << (2. * value - left - right) / (step * step), -cross, -cross,
          (2. * value - down - up) / (step * step);
      // At least as wide as the prior.
      curvature.diagonal() = curvature.diagonal().cwiseMax(0.1);
      determinant = std::max(curvature.determinant(), 0.01);
      const Eigen::Vector2d slope((right - left) / (2. * step), (up - down) / (2. * step));
      if (i < iterations)
        at += (curvature.inverse() * slope).cwiseMin(longest).cwiseMax(-longest);
    }
    const auto log_prior = [&](const std::string &name, const Place &place) {
      const double sides = static_cast<double>(places.at(name).size()) / n_places;
      return -std::log(sides * std::log(place.strongest / just_visible));
    };
    return value + log_prior(a, p) + log_prior(b, q) + std::log(2. * M_PI) -
           0.5 * std::log(determinant);
  }

  Eigen::Index size() const
  {
    Eigen::Index sum = 0;
    for (const auto &[experiment, part] : parts)
      sum += part.size();
    return sum;
  }

  template <typename Values>
  Eigen::VectorXd joined(const Values &of_experiment) const
  {
    Eigen::VectorXd result(size());
    Eigen::Index first = 0;
    for (const auto &[experiment, part] : parts) {
      result.segment(first, part.size()) = of_experiment(experiment, part);
      first += part.size();
    }
    return result;
  }

  Eigen::VectorXd data() const
  {
    return joined([](const std::string &, const Eigen::VectorXd &part) { return part; });
  }

  Eigen::VectorXd mean(const Amplitudes &truth) const
  {
    return joined([&](const std::string &experiment, const Eigen::VectorXd &) {
      return simulator.mean(experiment, truth);
    });
  }

  /// What nuisances add, which move all experiments together; and the covariance of all that is not
  /// an effect's.
  void covariance_of_nuisances()
  {
    nuisances = Eigen::MatrixXd::Zero(size(), size());
    for (const Factor &f : simulator.factors())
      if (f.kind == Factor::Kind::nuisance) {
        const Eigen::VectorXd column =
            mean({{f.name, f.null_value + f.prior_deviation}}) - mean({});
        nuisances += column * column.transpose();
      }
    base.compute(covariance({}));
  }

  Eigen::MatrixXd covariance(const Amplitudes &truth) const
  {
    Eigen::MatrixXd result = nuisances;
    Eigen::Index first = 0;
    for (const auto &[experiment, part] : parts) {
      const Eigen::Index n = part.size();
      const Eigen::MatrixXd one_run = simulator.covariance(experiment);
      result.block(first, first, n, n) +=
          one_run * std::pow(simulator.growth(experiment, truth), 2) / repeats;
      result.diagonal().segment(first, n) += instrument * instrument / repeats * one_run.diagonal();
      first += n;
    }
    return result;
  }

  /// Of the data, squared (Mahalanobis).
  double distance(const Amplitudes &truth) const
  {
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance(truth));
    return llt.matrixL().solve(data() - mean(truth)).squaredNorm();
  }

  double log_likelihood(const Amplitudes &truth) const
  {
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance(truth));
    return -0.5 * llt.matrixL().solve(data() - mean(truth)).squaredNorm() -
           half_log_determinant(llt);
  }

  const RecordedSimulator &simulator;
  const unsigned int repeats;
  const double instrument;
  std::map<std::string, Eigen::VectorXd> parts; ///< data of each experiment
  Eigen::MatrixXd nuisances;
  Eigen::LLT<Eigen::MatrixXd> base; ///< of the covariance without effects
  std::map<std::string, std::vector<Place>> places;
  std::vector<std::pair<double, std::string>> effects; ///< log evidence and name
};

} // namespace test

#endif
