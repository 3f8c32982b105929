#include <eunoe/discovery/stages/places.h>
#include <eunoe/discovery/stages/verification.h>

namespace eunoe::discovery {

namespace {

/// Runs to rest a fit on, and what the emulator foresees of them.
struct Verification
{
  std::string effects;
  Amplitudes amplitudes;
  Eigen::VectorXd foreseen; ///< in coordinates of the misfit
  double leverage;
  std::size_t before; ///< runs that were there
};

Verification prepare(Workbench &bench, const Fit &fit)
{
  const Eigen::VectorXd place = place_of_runs(bench, fit);
  Amplitudes amplitudes = near_amplitudes(bench, fit.effects, place);
  // Where there are so many runs already, others nearby teach more.
  constexpr std::size_t plenty = 3;
  if (bench.runs[amplitudes].size() >= plenty * bench.options.fit_runs)
    amplitudes = bench.amplitudes(fit.effects, place);
  Eigen::VectorXd position = fit.position;
  for (std::size_t k = 0; k < fit.effects.size(); ++k) {
    const Factor &effect = bench.effects[fit.effects[k]];
    const auto found = amplitudes.find(effect.name);
    position(static_cast<Eigen::Index>(k)) =
        found == amplitudes.end() ? 0. : (found->second - effect.null_value) / effect.scale;
  }
  const Response response = bench.response(fit.effects);
  return {name_of(bench, fit.effects), amplitudes, response.origin() + response.change(position),
          response.leverage(position), bench.runs[amplitudes].size()};
}

/// How well the emulator had foreseen the runs that were made since.
Table describe(Workbench &bench, const Verification &verification)
{
  const auto &sets = bench.runs[verification.amplitudes];
  Table row = {{"effects", verification.effects}, {"amplitudes", Table::object()}};
  for (const auto &[name, value] : verification.amplitudes)
    row["amplitudes"][name] = value;
  row["runs"] = sets.size();
  if (sets.size() == verification.before)
    return row;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(bench.misfit.size());
  const auto fresh = static_cast<double>(sets.size() - verification.before);
  for (std::size_t k = verification.before; k < sets.size(); ++k)
    mean += bench.misfit.coordinates(sets[k].modes) / fresh;
  row["distance to what the emulator foresaw, over its expectation"] =
      (mean - verification.foreseen).squaredNorm() /
      ((verification.leverage + 1. / fresh) * static_cast<double>(bench.misfit.size()));
  return row;
}

} // namespace

bool is_verified(const Workbench &bench, const Fit &fit)
{
  const Eigen::VectorXd place = place_of_runs(bench, fit);
  const auto there = bench.runs.find(near_amplitudes(bench, fit.effects, place));
  return place == fit.position && there != bench.runs.end() && !there->second.empty();
}

Table verify(Workbench &bench, const std::vector<Fit> &fits, const unsigned int number)
{
  std::vector<Verification> verifications;
  std::vector<Workbench::Order> orders;
  for (const Fit &fit : fits) {
    verifications.push_back(prepare(bench, fit));
    const Verification &last = verifications.back();
    orders.push_back({last.amplitudes, static_cast<unsigned int>(last.before) + number});
  }
  bench.ask(orders);
  Table rows = Table::array();
  for (const Verification &verification : verifications)
    rows.push_back(describe(bench, verification));
  return rows;
}

} // namespace eunoe::discovery
