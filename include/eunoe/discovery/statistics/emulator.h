#ifndef eunoe_discovery_statistics_emulator_h
#define eunoe_discovery_statistics_emulator_h

#include <Eigen/Dense>
#include <vector>

namespace eunoe::discovery {

/// How strongly the outcome responds to each effect: mean square over all values of the change by
/// one scale, in units of a replicate's covariance.
struct Slopes
{
  Eigen::VectorXd overall;  ///< of all amplitudes together
  Eigen::VectorXd steepest; ///< at the amplitude with the largest ratio of change to amplitude
};

/// Emulator: the mean outcome of a run as a polynomial of the amplitudes of a few effects, by
/// generalised least squares. It has kinks at amplitudes that are followed by far larger ones. All
/// runs have the same covariance C up to a factor, so the variance of a prediction is C times one
/// number, its leverage.
class Emulator
{
public:
  struct Run
  {
    Eigen::VectorXd position; ///< amplitude of each effect less its null value, over its scale
    Eigen::VectorXd values;
    double variance = 1.; ///< in units of C
  };

  Emulator() = default;

  /// @param runs at least one of them at the origin
  /// @param slopes The expected nonlinearity is in proportion to them. (Noise in the slope at a
  ///   fitted amplitude would make its interval too narrow.)
  Emulator(const std::vector<Run> &runs, const Slopes &slopes);

  /// Predicted outcome at the origin.
  Eigen::VectorXd origin() const { return coefficients.row(0).transpose(); }
  double origin_leverage() const { return inverse(0, 0); }

  /// Predicted change from the origin to a position, and its leverage.
  Eigen::VectorXd change(const Eigen::VectorXd &position) const;
  double change_leverage(const Eigen::VectorXd &position) const;
  /// Leverage of the outcome itself, origin and change. It includes the nonlinearity that may be
  /// hidden between the origin and the first amplitude that was run.
  double leverage(const Eigen::VectorXd &position) const;
  /// Variance of each effect's change, over the change squared, at positions between the origin and
  /// the first amplitude that was run. The prior there: the slope is that beyond the first
  /// amplitude, plus a random walk along the logarithm of the amplitude.
  Eigen::VectorXd unseen_bends(const Eigen::VectorXd &position) const;

  /// The emulator for another mean of the runs at the origin: the origin moves, and so does every
  /// change that is measured from it.
  Emulator with_shifted_base(const Eigen::VectorXd &shift) const;

  /// The same emulator with its values in other coordinates.
  Emulator transformed(const Eigen::MatrixXd &transform) const;

  /// Range of one effect's amplitudes that were run, with half as much again on either side.
  double lower(Eigen::Index effect) const { return least(effect); }
  double upper(Eigen::Index effect) const { return most(effect); }

private:
  /// A product of powers, powers[k] of effect k; with a knot, the part of one effect beyond it.
  struct Term
  {
    std::vector<int> powers;
    double knot = 0.;
  };
  void add_terms(const std::vector<Run> &runs, Eigen::Index n_effects);
  /// Inverse of the prior mean square of a term's coefficient; 0: no prior.
  double stiffness(const Term &term, const std::vector<Run> &runs, const Slopes &slopes) const;
  Eigen::VectorXd terms_at(const Eigen::VectorXd &position) const;

  std::vector<Term> terms;
  Eigen::MatrixXd coefficients; ///< terms x values
  Eigen::MatrixXd inverse;      ///< covariance of the coefficients in units of C
  Eigen::VectorXd least, most;
  Eigen::VectorXd first_below,
      first_above;         ///< amplitudes nearest to the origin that were run; 0: none
  Eigen::VectorXd overall; ///< squares of slopes, in units of C
  double base_weight = 0.; ///< of the runs at the origin
};

} // namespace eunoe::discovery

#endif
