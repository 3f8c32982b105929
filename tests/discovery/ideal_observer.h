#ifndef eunoe_tests_discovery_ideal_observer_h
#define eunoe_tests_discovery_ideal_observer_h

// The ceiling of detection and naming: an observer who knows the fingerprint and the scatter of
// every effect at every amplitude exactly, and the noise of the instrument, but neither amplitude
// nor nuisances. No study can detect or name more effects rightly.

#include <eunoe/discovery/inference/evidence.h>

#include "recorded.h"

namespace test {

class IdealObserver
{
public:
  /// @param instrument noise of a repeat at each data point, as a share of a run's scatter
  IdealObserver(const RecordedSimulator &simulator, const std::vector<MeasuredPoint> &data,
                unsigned int repeats, double instrument)
      : simulator(simulator), repeats(repeats), instrument(instrument)
  {
    for (const MeasuredPoint &point : data) {
      Part &part = parts[point.point.experiment];
      part.values.conservativeResize(part.values.size() + 1);
      part.values(part.values.size() - 1) = point.value;
    }
    for (const Factor &f : simulator.factors())
      if (f.kind == Factor::Kind::effect)
        effects.emplace_back(log_evidence(f), f.name);
    std::sort(effects.begin(), effects.end());
  }

  /// The likeliest single effects, which together have a probability; the likeliest first.
  std::vector<std::string> names(const double probability) const
  {
    std::vector<double> logs;
    for (const auto &[log, name] : effects)
      logs.push_back(log);
    const double total = log_sum(logs);
    std::vector<std::string> list;
    double sum = 0.;
    for (auto it = effects.rbegin(); it != effects.rend() && sum < probability; ++it) {
      list.push_back(it->second);
      sum += std::exp(it->first - total);
    }
    return list;
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
  struct Part
  {
    Eigen::VectorXd values;
  };

  std::vector<std::string> experiments() const
  {
    std::vector<std::string> names;
    for (const auto &[name, part] : parts)
      names.push_back(name);
    return names;
  }

  /// Log of the mean likelihood over strengths in a geometric sequence, from the smallest that can
  /// be seen to that of the end of the range.
  double log_evidence(const Factor &f) const
  {
    constexpr int places = 30;
    constexpr double just_visible = 1., strongest = 50.;
    std::vector<double> logs;
    for (const double limit : {f.lower, f.upper}) {
      const double side = limit < f.null_value ? -1. : 1.;
      if (limit == f.null_value ||
          f.sign == (side > 0. ? Factor::Sign::below : Factor::Sign::above))
        continue;
      const double last = std::min(strongest, simulator.strength({{f.name, limit}}, experiments()));
      for (int k = 0; k < places && just_visible < last; ++k) {
        const double strength = just_visible * std::pow(last / just_visible, k / (places - 1.));
        logs.push_back(log_likelihood(
            {{f.name, simulator.amplitude_of(f.name, strength, experiments(), side)}}));
      }
    }
    return logs.empty() ? -1e300 : log_sum(logs) - std::log(static_cast<double>(logs.size()));
  }

  double log_likelihood(const Amplitudes &truth) const
  {
    // Nuisances move all experiments together.
    Eigen::Index size = 0;
    for (const auto &[experiment, part] : parts)
      size += part.values.size();
    Eigen::VectorXd deviation(size);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
    Eigen::Index first = 0;
    std::vector<Eigen::VectorXd> columns(simulator.factors().size(), Eigen::VectorXd::Zero(size));
    for (const auto &[experiment, part] : parts) {
      const Eigen::Index n = part.values.size();
      deviation.segment(first, n) = part.values - simulator.mean(experiment, truth);
      const Eigen::MatrixXd one_run =
          simulator.covariance(experiment) * std::pow(simulator.growth(experiment, truth), 2);
      covariance.block(first, first, n, n) = one_run / repeats;
      covariance.diagonal().segment(first, n) +=
          instrument * instrument / repeats * simulator.covariance(experiment).diagonal();
      for (std::size_t q = 0; q < columns.size(); ++q)
        if (const Factor &f = simulator.factors()[q]; f.kind == Factor::Kind::nuisance)
          columns[q].segment(first, n) =
              simulator.mean(experiment, {{f.name, f.null_value + f.prior_deviation}}) -
              simulator.mean(experiment, {});
      first += n;
    }
    for (const Eigen::VectorXd &column : columns)
      covariance += column * column.transpose();
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
    return -0.5 * llt.matrixL().solve(deviation).squaredNorm() -
           Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum();
  }

  const RecordedSimulator &simulator;
  const unsigned int repeats;
  const double instrument;
  std::map<std::string, Part> parts;
  std::vector<std::pair<double, std::string>> effects; ///< log evidence and name
};

} // namespace test

#endif
