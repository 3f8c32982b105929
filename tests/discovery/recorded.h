#ifndef eunoe_tests_discovery_recorded_h
#define eunoe_tests_discovery_recorded_h

// A simulator that draws from recorded simulations. The records give the means and the growth of
// the scatter at the recorded amplitudes, and the scatter of the base model. The truth is these
// means less the share of their changes that noise explains (James and Stein), with linear
// interpolation between amplitudes, and extrapolation of the last piece beyond them. Nuisances,
// which move little, change data points in proportion. Effects add. A replicate is the mean plus a
// recorded deviation of the base model, mixed with independent noise of each data point by Ledoit
// and Wolf's share, so that its covariance is their estimate.

#include <eunoe/discovery/statistics/covariance.h>

#include "known_simulator.h"
#include "recorded_table.h"

#include <set>

namespace test {

/// Records that serve as data and not for the simulator: seeds of the base model, or one amplitude
/// of a factor.
struct LeftOut
{
  std::set<std::uint32_t> base_seeds;
  std::string factor;
  double amplitude = 0.;
};

class RecordedSimulator : public KnownSimulator
{
public:
  /// @param seed of the scatter
  RecordedSimulator(const RecordedTable &table, std::uint32_t seed, LeftOut left_out = {})
      : seed(seed), left_out(std::move(left_out))
  {
    all_points = table.points;
    all_factors = table.factors;
    for (const auto &[experiment, points] : table.points) {
      make_chaos(table, experiment);
      for (const Factor &factor : table.factors)
        make_pieces(table, experiment, factor);
    }
  }

  Eigen::VectorXd mean(const std::string &experiment, const Amplitudes &amplitudes) const override
  {
    Eigen::VectorXd result = chaos.at(experiment).mean;
    for (const auto &[name, amplitude] : amplitudes)
      result += at(experiment, name, amplitude).change;
    return result;
  }

  bool concerns(const std::string &experiment,
                const std::vector<std::string> &effects) const override
  {
    return effects.empty() || std::any_of(effects.begin(), effects.end(), [&](const auto &name) {
             return all_pieces.at(name).at(experiment).size() > 1;
           });
  }

  /// Covariance of the values of one run of the base model.
  Eigen::MatrixXd covariance(const std::string &experiment) const
  {
    return half.at(experiment) * half.at(experiment).transpose();
  }

  /// Scatter of runs over that of the base model's.
  double growth(const std::string &experiment, const Amplitudes &amplitudes) const
  {
    double product = 1.;
    for (const auto &[name, amplitude] : amplitudes)
      product *= at(experiment, name, amplitude).growth;
    return product;
  }

  /// Variance of the recorded means that are the truth here, over the squared change by a factor at
  /// an amplitude: how much of a fingerprint is noise (Mahalanobis, independent of the amplitude as
  /// far as the response is in proportion).
  double share_of_noise(const std::string &name, double amplitude,
                        const std::vector<std::string> &experiments) const
  {
    double noise = 0.;
    for (const std::string &e : experiments) {
      const Piece piece = at(e, name, amplitude);
      noise += piece.variance * static_cast<double>(all_points.at(e).size());
    }
    const double strong = strength({{name, amplitude}}, experiments);
    return strong > 0. ? noise / (strong * strong) : 1.;
  }

private:
  struct Chaos
  {
    Eigen::VectorXd mean, deviation;
    Eigen::MatrixXd rows; ///< deviations of recorded runs from their mean
    double own_share = 0.;
  };

  /// An amplitude of a factor: change of the mean from the base model, how much larger the scatter
  /// is, and the variance of the change in units of one run's scatter.
  struct Piece
  {
    double amplitude = 0.;
    Eigen::VectorXd change;
    double growth = 1., variance = 0.;
  };

  void make_chaos(const RecordedTable &table, const std::string &experiment)
  {
    std::vector<const RecordedTable::Run *> used;
    for (const RecordedTable::Run *run : table.of(experiment, "base"))
      if (left_out.base_seeds.count(run->seed) == 0)
        used.push_back(run);
    const auto n = static_cast<Eigen::Index>(used.size());
    Eigen::MatrixXd rows(n, used.front()->values.size());
    for (Eigen::Index r = 0; r < n; ++r)
      rows.row(r) = used[static_cast<std::size_t>(r)]->values.transpose();
    Chaos &own = chaos[experiment];
    own.mean = rows.colwise().mean().transpose();
    own.rows = centred(rows) * std::sqrt(static_cast<double>(n) / static_cast<double>(n - 1));
    // In units of each data point's own scatter, as they have different ones.
    own.deviation = (own.rows.colwise().squaredNorm() / static_cast<double>(n)).cwiseSqrt();
    const auto scale = own.deviation.asDiagonal();
    const Covariance covariance =
        shrunk_covariance(centred(rows) * scale.inverse(), static_cast<double>(n - 1));
    own.own_share = covariance.shrinkage;
    half[experiment] =
        scale * Eigen::MatrixXd(Eigen::LLT<Eigen::MatrixXd>(covariance.matrix).matrixL());
  }

  void make_pieces(const RecordedTable &table, const std::string &experiment, const Factor &factor)
  {
    std::map<double, std::vector<const RecordedTable::Run *>> by_amplitude;
    std::map<std::uint32_t, Eigen::VectorXd> base;
    for (const RecordedTable::Run *run : table.of(experiment, "base"))
      base[run->seed] = run->values;
    bool without_trace = true;
    for (const RecordedTable::Run *run : table.of(experiment, factor.name)) {
      without_trace =
          without_trace && base.count(run->seed) > 0 && run->values == base.at(run->seed);
      if (factor.name != left_out.factor || run->amplitude != left_out.amplitude)
        by_amplitude[run->amplitude].push_back(run);
    }
    std::vector<Piece> &pieces = all_pieces[factor.name][experiment];
    const Chaos &own = chaos.at(experiment);
    pieces.push_back({factor.null_value, Eigen::VectorXd::Zero(own.mean.size())});
    if (without_trace)
      return; // an effect that this process cannot have
    if (factor.kind == Factor::Kind::nuisance)
      return add_linear_pieces(experiment, factor, by_amplitude, pieces);
    for (const auto &[amplitude, runs] : by_amplitude) {
      const auto n = static_cast<double>(runs.size());
      Piece piece{amplitude, Eigen::VectorXd::Zero(own.mean.size())};
      for (const auto *run : runs)
        piece.change += (run->values - own.mean) / n;
      double square = 0.;
      for (const auto *run : runs)
        square +=
            (run->values - own.mean - piece.change).cwiseQuotient(own.deviation).squaredNorm();
      if (runs.size() > 1)
        piece.growth = std::clamp(
            std::sqrt(square / (n - 1.) / static_cast<double>(own.mean.size())), 0.3, 3.);
      piece.variance = 1. / n + 1. / static_cast<double>(own.rows.rows());
      take_noise_off(experiment, piece);
      pieces.push_back(piece);
    }
    std::sort(pieces.begin(), pieces.end(),
              [](const Piece &a, const Piece &b) { return a.amplitude < b.amplitude; });
  }

  void take_noise_off(const std::string &experiment, Piece &piece) const
  {
    const auto &lower = half.at(experiment).triangularView<Eigen::Lower>();
    const double square = lower.solve(piece.change).squaredNorm();
    const double noise = piece.variance * static_cast<double>(piece.change.size());
    piece.change *= square > noise ? 1. - noise / square : 0.;
  }

  /// The slope through all amplitudes by least squares, to both sides.
  void add_linear_pieces(
      const std::string &experiment, const Factor &factor,
      const std::map<double, std::vector<const RecordedTable::Run *>> &by_amplitude,
      std::vector<Piece> &pieces) const
  {
    const Chaos &own = chaos.at(experiment);
    Piece slope{1., Eigen::VectorXd::Zero(own.mean.size())};
    double squares = 0., sum = 0.;
    for (const auto &[amplitude, runs] : by_amplitude)
      for (const auto *run : runs) {
        const double u = amplitude - factor.null_value;
        slope.change += u * (run->values - own.mean);
        squares += u * u;
        sum += u;
      }
    slope.change /= squares;
    slope.variance =
        1. / squares + sum * sum / (squares * squares * static_cast<double>(own.rows.rows()));
    take_noise_off(experiment, slope);
    pieces.insert(pieces.begin(), {factor.null_value - 1., -slope.change, 1., slope.variance});
    pieces.push_back({factor.null_value + 1., slope.change, 1., slope.variance});
  }

  Piece at(const std::string &experiment, const std::string &name, double amplitude) const
  {
    const std::vector<Piece> &pieces = all_pieces.at(name).at(experiment);
    if (pieces.size() == 1)
      return pieces.front();
    std::size_t k = 1;
    while (k + 1 < pieces.size() && pieces[k].amplitude < amplitude)
      ++k;
    const Piece &a = pieces[k - 1], &b = pieces[k];
    const double share = (amplitude - a.amplitude) / (b.amplitude - a.amplitude);
    return {amplitude, (1. - share) * a.change + share * b.change,
            std::clamp((1. - share) * a.growth + share * b.growth, 0.3, 3.),
            std::pow((1. - share), 2) * a.variance + share * share * b.variance};
  }

  Eigen::VectorXd value(const std::string &experiment, const Amplitudes &amplitudes,
                        std::uint32_t run_seed) const override
  {
    const Chaos &own = chaos.at(experiment);
    std::string text;
    for (const auto &[name, amplitude] : amplitudes)
      if (all_pieces.at(name).at(experiment).size() > 1)
        text += name + std::to_string(amplitude);
    RandomStream random(run_seed, hash(experiment + "|" + text) + 31u * seed);
    const auto row =
        static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(own.rows.rows())));
    const Eigen::VectorXd noise =
        own.deviation.cwiseProduct(random.normals(1, own.mean.size()).row(0).transpose());
    return mean(experiment, amplitudes) +
           growth(experiment, amplitudes) *
               (std::sqrt(1. - own.own_share) * own.rows.row(row).transpose() +
                std::sqrt(own.own_share) * noise);
  }

  const std::uint32_t seed;
  const LeftOut left_out;
  std::map<std::string, Chaos> chaos;
  std::map<std::string, std::map<std::string, std::vector<Piece>>> all_pieces;
};

} // namespace test

#endif
