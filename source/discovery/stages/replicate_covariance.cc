#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace eunoe::discovery {

namespace {

/// Replicates at one design point: deviations from their mean, in modes, a row each.
struct Group
{
  Eigen::MatrixXd deviations;
  std::vector<std::uint32_t> seeds;
};

Group group_of(const std::vector<Replicate> &sets)
{
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(sets.size()), sets.front().modes.size());
  Group group;
  for (std::size_t r = 0; r < sets.size(); ++r) {
    rows.row(static_cast<Eigen::Index>(r)) = sets[r].modes.transpose();
    group.seeds.push_back(sets[r].seed);
  }
  group.deviations = centred(rows);
  return group;
}

/// Replicates of models other than the base model, with weights. They use the same seeds as the
/// base model and as each other, so that runs with one seed are correlated: n of them with
/// correlation rho weigh as much as n / (1 + n rho^2) runs of the base model. The correlation
/// differs between experiments. Where an effect does not change an experiment at all, its runs are
/// equal to those of the base model and have no weight.
class OtherModels
{
public:
  OtherModels(const StudyState &study, const Group &base, const Eigen::VectorXd &variance)
      : block(study.modes.experiment_of_mode()),
        n_blocks(1 + *std::max_element(block.begin(), block.end()))
  {
    for (std::size_t r = 0; r < base.seeds.size(); ++r)
      row_of_seed[base.seeds[r]] = static_cast<Eigen::Index>(r);
    for (const auto &[amplitudes, sets] : study.replicates) {
      if (amplitudes.empty() || sets.size() < 2)
        continue;
      Group group = group_of(sets);
      // Scaled to the total variance of the base model.
      const double ratio =
          (group.deviations.colwise().squaredNorm().transpose().array() / variance.array()).mean() /
          static_cast<double>(sets.size() - 1);
      if (!(ratio > 0.))
        continue;
      traces.push_back(find_trace(study, sets));
      for (const std::uint32_t seed : group.seeds)
        runs_of_seed[seed] += 1.;
      group.deviations /= std::sqrt(ratio);
      groups.push_back(std::move(group));
    }
    const Eigen::ArrayXd unit = variance.cwiseSqrt().cwiseInverse();
    find_correlations(base.deviations * unit.matrix().asDiagonal(), unit);
  }

  /// All deviations, each times the root of its weight.
  Eigen::MatrixXd rows() const
  {
    Eigen::Index n = 0;
    for (const Group &group : groups)
      n += group.deviations.rows();
    Eigen::MatrixXd result(n, static_cast<Eigen::Index>(block.size()));
    Eigen::Index row = 0;
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (Eigen::Index r = 0; r < groups[g].deviations.rows(); ++r, ++row)
        for (std::size_t m = 0; m < block.size(); ++m) {
          const auto k = static_cast<Eigen::Index>(m);
          result(row, k) =
              groups[g].deviations(r, k) *
              std::sqrt(weight(g, groups[g].seeds[static_cast<std::size_t>(r)], block[m]));
        }
    return result;
  }

  /// Degrees of freedom that they add in each experiment.
  Eigen::VectorXd degrees_of_freedom() const
  {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(n_blocks);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const auto n = static_cast<double>(groups[g].seeds.size());
      for (const std::uint32_t seed : groups[g].seeds)
        for (int b = 0; b < n_blocks; ++b)
          result(b) += weight(g, seed, b) * (n - 1.) / n;
    }
    return result;
  }

private:
  /// Whether the runs differ at all from those of the base model with their seeds.
  std::vector<bool> find_trace(const StudyState &study, const std::vector<Replicate> &sets) const
  {
    std::vector<bool> trace(static_cast<std::size_t>(n_blocks), false);
    for (const Replicate &set : sets) {
      const auto same = row_of_seed.find(set.seed);
      for (std::size_t m = 0; m < block.size(); ++m) {
        const auto k = static_cast<Eigen::Index>(m);
        if (same == row_of_seed.end() ||
            set.modes(k) != study.base()[static_cast<std::size_t>(same->second)].modes(k))
          trace[static_cast<std::size_t>(block[m])] = true;
      }
    }
    return trace;
  }

  /// @param base deviations, in standard deviations
  /// @param unit inverse standard deviations
  void find_correlations(const Eigen::MatrixXd &base, const Eigen::ArrayXd &unit)
  {
    correlation = products = squares = base_squares = Eigen::VectorXd::Zero(n_blocks);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      std::vector<Eigen::Index> here, there;
      for (std::size_t r = 0; r < groups[g].seeds.size(); ++r)
        if (const auto same = row_of_seed.find(groups[g].seeds[r]); same != row_of_seed.end()) {
          here.push_back(static_cast<Eigen::Index>(r));
          there.push_back(same->second);
        }
      if (here.size() < 2)
        continue;
      const Eigen::MatrixXd mine =
          centred(groups[g].deviations(here, Eigen::all)) * unit.matrix().asDiagonal();
      const Eigen::MatrixXd theirs = centred(base(there, Eigen::all));
      for (std::size_t m = 0; m < block.size(); ++m) {
        const auto k = static_cast<Eigen::Index>(m);
        if (!traces[g][static_cast<std::size_t>(block[m])])
          continue;
        products(block[m]) += mine.col(k).dot(theirs.col(k));
        squares(block[m]) += mine.col(k).squaredNorm();
        base_squares(block[m]) += theirs.col(k).squaredNorm();
      }
    }
    for (int b = 0; b < n_blocks; ++b)
      if (squares(b) > 0. && base_squares(b) > 0.)
        correlation(b) = std::clamp(products(b) / std::sqrt(squares(b) * base_squares(b)), 0., 1.);
  }

  double weight(std::size_t group, std::uint32_t seed, int experiment) const
  {
    if (!traces[group][static_cast<std::size_t>(experiment)])
      return 0.;
    // The base model's own run of the seed is one more.
    const double n = runs_of_seed.at(seed) - (row_of_seed.count(seed) > 0 ? 0. : 1.);
    return 1. / (1. + n * correlation(experiment) * correlation(experiment));
  }

  const std::vector<int> &block; ///< experiment of each mode
  const int n_blocks;
  std::vector<Group> groups;
  std::vector<std::vector<bool>> traces; ///< of each group in each experiment
  std::map<std::uint32_t, Eigen::Index> row_of_seed;
  std::map<std::uint32_t, double> runs_of_seed;
  Eigen::VectorXd correlation, products, squares, base_squares;
};

} // namespace

void estimate_replicate_covariance(StudyState &study)
{
  const Group base = group_of(study.base());
  const auto base_dof = static_cast<double>(base.deviations.rows() - 1);
  const Eigen::VectorXd variance =
      (base.deviations.colwise().squaredNorm().transpose() / base_dof).cwiseMax(1e-6);

  // Replicates of other models add to the estimate, and there are many more of them.
  const OtherModels others(study, base, variance);
  const Eigen::VectorXd dof = others.degrees_of_freedom().array() + base_dof;
  const Eigen::MatrixXd more = others.rows();
  Eigen::MatrixXd all(base.deviations.rows() + more.rows(), base.deviations.cols());
  all << base.deviations, more;
  study.replicate_degrees_of_freedom = dof.minCoeff();
  for (Eigen::Index m = 0; m < all.cols(); ++m)
    all.col(m) *= std::sqrt(study.replicate_degrees_of_freedom /
                            dof(study.modes.experiment_of_mode()[static_cast<std::size_t>(m)]));
  study.replicate_covariance =
      shrunk_covariance(all, study.replicate_degrees_of_freedom, study.modes.experiment_of_mode());
  // A floor for modes that hardly vary.
  study.replicate_covariance.matrix.diagonal().array() += 1e-3;

  Eigen::MatrixXd points(base.deviations.rows(), study.modes.n_points());
  for (Eigen::Index r = 0; r < points.rows(); ++r)
    points.row(r) = study.measured(study.base()[static_cast<std::size_t>(r)].values)
                        .cwiseQuotient(study.modes.deviations())
                        .transpose();
  study.replicate_variance =
      (centred(points).colwise().squaredNorm().transpose() / base_dof).cwiseMax(0.04);
  study.noise =
      estimate_data_noise(study.modes, study.replicate_covariance.matrix, study.replicate_variance,
                          {study.deviation.cwiseQuotient(study.modes.deviations()), study.repeats});
  const Misfit::Tail tail = study.misfit.tail;
  study.misfit = Misfit(study.replicate_covariance.matrix,
                        study.other_covariance(study.noise, study.replicate_covariance.matrix));
  study.misfit.tail = tail;
}

} // namespace eunoe::discovery
