#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/sha256.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/dem_simulator.h>
#include <eunoe/discovery/measured_csv.h>
#include <eunoe/discovery/results.h>
#include <eunoe/discovery/synthetic_data.h>
#include <eunoe/simulation/command_line.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

namespace eunoe::discovery {

namespace {

/// A nuisance that only the truth has.
const std::string time_step_change = "time step of the truth";

/// Normal numbers, the same everywhere: the standard library's distribution is not.
class NormalNumbers
{
public:
  explicit NormalNumbers(const std::uint64_t seed) : generator(seed) {}

  double operator()()
  {
    const double u = (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53;
    const double v = (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53;
    return std::sqrt(-2. * std::log(u)) * std::cos(2. * M_PI * v);
  }

private:
  std::mt19937_64 generator;
};

/// Effects and amplitudes of "name: amplitude, ...".
Amplitudes truth_of(const SyntheticDataParameters &synthetic, const std::vector<Effect> &factors)
{
  Problems problems;
  Amplitudes truth;
  std::vector<std::string> names;
  for (const Effect &effect : factors)
    if (effect.kind == Factor::Kind::effect)
      names.push_back(effect.name);
  const std::string where = "subsection 'twin' / entry 'effects'";
  for (const std::string &text : synthetic.effects) {
    const std::size_t colon = text.find(':');
    const std::string name = boost::trim_copy(text.substr(0, colon));
    const std::string number =
        colon == std::string::npos ? "" : boost::trim_copy(text.substr(colon + 1));
    char *end;
    const double amplitude = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0' || !std::isfinite(amplitude))
      problems.add(where, "has '" + text + "'.", "Write 'name: amplitude'.");
    else if (std::find(names.begin(), names.end(), name) == names.end())
      problems.add(where, "names '" + name + "', which is not in the catalogue.",
                   "There are: " + boost::join(names, ", ") + ".");
    else
      truth[name] = amplitude;
  }
  if (!problems.empty())
    throw UserError(problems);
  return truth;
}

/// The experiments with the overrides of the truth.
std::vector<Experiment> experiments_of(const StudyParameters &study, MPI_Comm comm)
{
  Problems problems;
  std::vector<Experiment> experiments;
  for (ExperimentParameters e : study.experiments) {
    e.overrides.insert(e.overrides.end(), study.synthetic.overrides.begin(),
                       study.synthetic.overrides.end());
    experiments.emplace_back(e, comm, problems);
  }
  if (!problems.empty())
    throw UserError(problems);
  return experiments;
}

/// Readings of an instrument with noise, from simulated repeats.
/// @param runs values of all data points, one row per repeat
std::vector<MeasuredPoint> measure(const std::vector<DataPoint> &points,
                                   const std::vector<std::vector<double>> &runs,
                                   const SyntheticDataParameters &synthetic, NormalNumbers &normal)
{
  const bool takes_all = synthetic.observables == std::vector<std::string>{"all"};
  const auto n = static_cast<double>(runs.size());
  std::map<std::string, std::pair<double, double>> squares; // sum and number, by observable
  for (std::size_t c = 0; c < points.size(); ++c)
    for (const std::vector<double> &values : runs)
      if (std::isfinite(values[c])) { // a bin may be empty in some of them
        squares[points[c].observable].first += values[c] * values[c];
        squares[points[c].observable].second += 1.;
      }
  std::vector<MeasuredPoint> rows;
  for (std::size_t c = 0; c < points.size(); ++c) {
    const auto &[sum, number] = squares[points[c].observable];
    const double size = std::sqrt(sum / number);
    std::vector<double> readings;
    for (const std::vector<double> &values : runs)
      readings.push_back(values[c] + synthetic.noise * size * normal());
    MeasuredPoint row;
    row.point = points[c];
    row.repeats = static_cast<unsigned int>(runs.size());
    for (const double reading : readings)
      row.value += reading / n;
    for (const double reading : readings)
      row.standard_deviation += (reading - row.value) * (reading - row.value) / (n - 1.);
    row.standard_deviation = std::max(std::sqrt(row.standard_deviation), 1e-9 * size);
    const bool is_wanted =
        takes_all ||
        std::any_of(synthetic.observables.begin(), synthetic.observables.end(),
                    [&](const std::string &words) {
                      const std::string wanted = boost::erase_all_copy(words, " ");
                      return wanted == points[c].observable ||
                             wanted == points[c].observable + ":" + std::to_string(points[c].index);
                    });
    // A data point without a value, such as a loss that never happened, is not measured.
    if (is_wanted && std::isfinite(row.value) && row.standard_deviation > 0.)
      rows.push_back(row);
  }
  return rows;
}

/// Refuses observables that no experiment has, before any run is made.
void check_observables(const std::vector<std::string> &wanted,
                       const std::vector<Experiment> &experiments)
{
  Problems problems;
  for (const std::string &words : wanted) {
    const std::string name = boost::trim_copy(words.substr(0, words.find(':')));
    const bool is_there = std::any_of(experiments.begin(), experiments.end(), [&](const auto &e) {
      const auto &all = e.observables();
      return std::any_of(all.begin(), all.end(), [&](const auto &o) { return o.name == name; });
    });
    if (!is_there && words != "all")
      problems.add("subsection 'twin' / entry 'observables':",
                   "no experiment measures '" + shortened(name) + "'.",
                   "Give 'all', or names that eunoe-discovery --list-observables gives.");
  }
  if (!problems.empty())
    throw UserError(problems);
}

/// What is sealed: the hidden truth, and how the data were made of it.
struct Truth
{
  Amplitudes amplitudes;
  nlohmann::ordered_json sealed;
};

/// Draws the nuisances of the truth.
Truth draw_truth(const SyntheticDataParameters &synthetic, const std::vector<Effect> &factors,
                 NormalNumbers &normal)
{
  Truth truth;
  truth.amplitudes = truth_of(synthetic, factors);
  truth.sealed["effects"] = truth.amplitudes;
  truth.sealed["nuisances"] = nlohmann::ordered_json::object();
  for (const Effect &factor : factors)
    if (factor.kind == Factor::Kind::nuisance && synthetic.jitter_nuisances)
      truth.sealed["nuisances"][factor.name] = truth.amplitudes[factor.name] =
          factor.prior_deviation * normal();
  truth.amplitudes[time_step_change] = synthetic.time_step_factor - 1.;
  truth.sealed["time_step_factor"] = synthetic.time_step_factor;
  truth.sealed["overrides"] = synthetic.overrides;
  truth.sealed["noise"] = synthetic.noise;
  truth.sealed["repeats"] = synthetic.repeats;
  truth.sealed["seed"] = synthetic.seed;
  truth.sealed["engine"] = engine_digest();
  return truth;
}

/// Runs every experiment of the truth several times and measures it.
MeasuredData measure_truth(const SyntheticDataParameters &synthetic,
                           const std::vector<Experiment> &experiments, const Amplitudes &amplitudes,
                           DemSimulator &simulator, NormalNumbers &normal)
{
  // Above all seeds of studies.
  const std::uint32_t first_seed = 0x40000000u + (synthetic.seed * 64u & 0x3fffffffu);
  simulator.find_data_points(first_seed, amplitudes);
  std::vector<RunRequest> requests;
  for (const Experiment &experiment : experiments)
    for (unsigned int r = 0; r < synthetic.repeats; ++r)
      requests.push_back({experiment.name(), amplitudes, first_seed + r});
  const std::vector<RunResult> results = simulator.run(requests);

  MeasuredData data;
  std::size_t k = 0;
  for (const Experiment &experiment : experiments) {
    std::vector<std::vector<double>> runs;
    for (unsigned int r = 0; r < synthetic.repeats; ++r, ++k)
      if (results[k])
        runs.push_back(*results[k]);
    if (runs.size() < 2)
      throw UserError("The truth cannot be simulated in experiment '" + experiment.name() +
                      "': " + simulator.ledger().back().value("failure", "runs broke off."));
    for (const MeasuredPoint &row :
         measure(simulator.data_points(experiment.name()), runs, synthetic, normal))
      (experiment.is_held_out() ? data.held_out : data.fit).push_back(row);
    for (const ObservableDescription &o : experiment.observables())
      data.header[unit_key(o.name)] = o.unit;
  }
  return data;
}

} // namespace

void make_synthetic_data(const StudyParameters &study, const std::vector<Effect> &factors,
                         MPI_Comm comm, Log &log)
{
  const SyntheticDataParameters &synthetic = study.synthetic;
  const std::string data_file = study.measured_data, sealed_file = synthetic.sealed_file;
  try {
    on_first_rank(comm, [&] {
      std::error_code failure;
      for (const std::string &file : {data_file, sealed_file})
        if (std::filesystem::exists(file, failure))
          throw UserError(file + " is there already. Remove it, or name another file.");
    });
  } catch (const UserError &error) {
    throw RefusedInput(error);
  }

  NormalNumbers normal(synthetic.seed);
  const Truth truth = draw_truth(synthetic, factors, normal);
  std::vector<Effect> changes = factors;
  Problems none;
  changes.push_back(make_nuisance(
      {time_step_change, {"simulation control/time step"}, "${base * (1 + amplitude)}"}, none));
  const std::vector<Experiment> experiments = experiments_of(study, comm);
  check_observables(synthetic.observables, experiments);
  for (const std::string &file : {data_file, sealed_file})
    create_folder((std::filesystem::path(".") / file).parent_path().string(), comm);
  DemSimulator simulator(experiments, changes, sealed_file + ".runs.sqlite", study.ranks_per_run,
                         comm, log);
  MeasuredData data = measure_truth(synthetic, experiments, truth.amplitudes, simulator, normal);
  const std::string sealed_text = truth.sealed.dump(1) + "\n";
  data.header["made by"] = "eunoe-discovery --make-twin";
  data.header["sealed truth sha256"] = sha256(sealed_text);
  const StudyFolder here(".", comm);
  here.write(sealed_file, sealed_text);
  here.write(data_file, write_measured(data));
  log.line(data_file + " holds " + std::to_string(data.fit.size()) + " cells to fit and " +
           std::to_string(data.held_out.size()) + " that are held out; the truth is in " +
           sealed_file);
}

} // namespace eunoe::discovery
