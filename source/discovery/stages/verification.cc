#include <eunoe/discovery/stages/design.h>
#include <eunoe/discovery/stages/verification.h>

namespace eunoe::discovery {

namespace {

/// A design point for a fit, and the emulator's prediction there.
struct Verification
{
  std::string effects;
  Amplitudes amplitudes;
  Eigen::VectorXd predicted; ///< in coordinates of the misfit
  double leverage;
  std::size_t before; ///< number of replicates before
};

Verification prepare(StudyState &study, const Fit &fit)
{
  const Eigen::VectorXd place = next_design_position(study, fit);
  Amplitudes amplitudes = nearest_design_point(study, fit.effects, place);
  // If there are so many replicates already, those at the fit itself teach more.
  constexpr std::size_t plenty = 3;
  if (study.replicates[amplitudes].size() >= plenty * study.options.fit_runs)
    amplitudes = study.amplitudes(fit.effects, place);
  Eigen::VectorXd position = fit.position;
  for (std::size_t k = 0; k < fit.effects.size(); ++k) {
    const Factor &effect = study.effects[fit.effects[k]];
    const auto found = amplitudes.find(effect.name);
    position(static_cast<Eigen::Index>(k)) =
        found == amplitudes.end() ? 0. : (found->second - effect.null_value) / effect.scale;
  }
  const Emulator emulator = study.emulator(fit.effects);
  return {name_of(study, fit.effects), amplitudes, emulator.origin() + emulator.change(position),
          emulator.leverage(position), study.replicates[amplitudes].size()};
}

/// Compares the emulator's prediction with the replicates that were run since.
Table describe(StudyState &study, const Verification &verification)
{
  const auto &sets = study.replicates[verification.amplitudes];
  Table row = {{"effects", verification.effects}, {"amplitudes", Table::object()}};
  for (const auto &[name, value] : verification.amplitudes)
    row["amplitudes"][name] = value;
  row["runs"] = sets.size();
  if (sets.size() == verification.before)
    return row;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(study.misfit.size());
  const auto fresh = static_cast<double>(sets.size() - verification.before);
  for (std::size_t k = verification.before; k < sets.size(); ++k)
    mean += study.misfit.coordinates(sets[k].modes) / fresh;
  row["distance to what the emulator foresaw, over its expectation"] =
      (mean - verification.predicted).squaredNorm() /
      ((verification.leverage + 1. / fresh) * static_cast<double>(study.misfit.size()));
  return row;
}

} // namespace

bool is_verified(const StudyState &study, const Fit &fit)
{
  const Eigen::VectorXd place = next_design_position(study, fit);
  const auto there = study.replicates.find(nearest_design_point(study, fit.effects, place));
  return place == fit.position && there != study.replicates.end() && !there->second.empty();
}

Table verify(StudyState &study, const std::vector<Fit> &fits, const unsigned int number)
{
  std::vector<Verification> verifications;
  std::vector<DesignPoint> design;
  for (const Fit &fit : fits) {
    verifications.push_back(prepare(study, fit));
    const Verification &last = verifications.back();
    design.push_back({last.amplitudes, static_cast<unsigned int>(last.before) + number});
  }
  study.run_design(design);
  Table rows = Table::array();
  for (const Verification &verification : verifications)
    rows.push_back(describe(study, verification));
  return rows;
}

} // namespace eunoe::discovery
