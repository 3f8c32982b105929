#ifndef eunoe_discovery_statistics_response_h
#define eunoe_discovery_statistics_response_h

#include <Eigen/Dense>
#include <vector>

namespace eunoe::discovery {

/// How steeply runs respond to each effect: mean squares over values, in units of the covariance of
/// a run, of the change by one scale.
struct Slopes
{
  Eigen::VectorXd overall;  ///< of all amplitudes together
  Eigen::VectorXd steepest; ///< where the change over the amplitude is largest; at least overall
};

/// Emulator: the mean outcome of a run as a polynomial of the amplitudes of a few effects, by
/// generalised least squares, with kinks at amplitudes beyond which runs go on to far larger ones.
/// All runs have the same covariance C up to a factor, so the variance of a prediction is C times
/// one number, its leverage.
class Response
{
public:
  struct Run
  {
    Eigen::VectorXd position; ///< amplitude of each effect less its null value, over its scale
    Eigen::VectorXd values;
    double variance = 1.; ///< in units of C
  };

  Response() = default;

  /// @param runs at least one of them at the origin
  /// @param slopes How much a response may bend is expected in proportion to them; noise in the
  ///   slope at a fitted amplitude would make its interval too narrow.
  Response(const std::vector<Run> &runs, const Slopes &slopes);

  /// Predicted outcome at the origin.
  Eigen::VectorXd origin() const { return coefficients.row(0).transpose(); }
  double origin_leverage() const { return inverse(0, 0); }

  /// What is predicted to change from the origin to a position, and its leverage.
  Eigen::VectorXd change(const Eigen::VectorXd &position) const;
  double change_leverage(const Eigen::VectorXd &position) const;
  /// Leverage of the outcome itself, origin and change, with what bends unseen before the first
  /// amplitude that was run.
  double leverage(const Eigen::VectorXd &position) const;
  /// Variance of each effect's change over its square where it lies before the first amplitude that
  /// was run: its slope there is that beyond, but for a random walk along the logarithm of the
  /// amplitude.
  Eigen::VectorXd unseen_bends(const Eigen::VectorXd &position) const;

  /// What the fit would be had the mean of the runs at the origin come out differently: the origin
  /// moves, and every change that is measured from it.
  Response with_shifted_base(const Eigen::VectorXd &shift) const;

  /// Values in other coordinates.
  Response transformed(const Eigen::MatrixXd &transform) const;

  /// Amplitudes of one effect between which runs were made, with half as much again beyond.
  double lower(Eigen::Index effect) const { return least(effect); }
  double upper(Eigen::Index effect) const { return most(effect); }

private:
  /// A product of powers, powers[k] of effect k; with a knot, what one effect is beyond it.
  struct Term
  {
    std::vector<int> powers;
    double knot = 0.;
  };
  void add_terms(const std::vector<Run> &runs, Eigen::Index n_effects);
  /// Inverse mean square that is expected of a term's coefficient; 0: anything.
  double stiffness(const Term &term, const std::vector<Run> &runs, const Slopes &slopes) const;
  Eigen::VectorXd terms_at(const Eigen::VectorXd &position) const;

  std::vector<Term> terms;
  Eigen::MatrixXd coefficients; ///< terms x values
  Eigen::MatrixXd inverse;      ///< covariance of the coefficients in units of C
  Eigen::VectorXd least, most;
  Eigen::VectorXd first_below, first_above; ///< nearest amplitudes that were run; 0: none
  Eigen::VectorXd overall;                  ///< squares of slopes, in units of C
  double base_weight = 0.;                  ///< of the runs at the origin
};

} // namespace eunoe::discovery

#endif
