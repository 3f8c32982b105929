// Records simulations of a study's experiments as one table, from which the recorded suite draws:
// the base model with many seeds, and each effect and nuisance at a few amplitudes with fewer.
// Round after round adds one seed of everything, and the table is written after each forty runs, so
// that it can be cut short at any time; runs are kept in the study's cache, and the same command
// goes on.
//   record-runs study.prm table.txt [rounds] [sets of the base model a round] [amplitudes]
// The last is a file that gives amplitudes of factors, in scales from their null values: lines with
// a name and numbers behind it; '#' begins a comment.

#include <eunoe/core/files.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/sha256.h>
#include <eunoe/core/stop_request.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/dem_simulator.h>
#include <eunoe/discovery/study_input.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace {

using namespace eunoe;
using namespace eunoe::discovery;

/// Amplitudes at which a factor is recorded, in scales from its null value: on both sides if its
/// sign allows both, else over a wide range, as some effects are visible at a small share of their
/// scale.
std::vector<double> levels(const Factor &factor)
{
  if (factor.kind == Factor::Kind::nuisance)
    return {-2., 2.};
  if (factor.sign == Factor::Sign::both)
    return {-1., 0.4, 1.};
  return factor.sign == Factor::Sign::above ? std::vector<double>{0.2, 0.7, 2.}
                                            : std::vector<double>{-0.2, -0.7, -2.};
}

using Levels = std::map<std::string, std::vector<double>>;

Levels read_levels(const std::string &path, const std::vector<Factor> &factors)
{
  Levels result;
  std::istringstream lines(read_file(path, MPI_COMM_WORLD));
  unsigned int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    std::string name;
    if (!(words >> name))
      continue;
    std::vector<double> &numbers = result[name];
    for (double level; words >> level;)
      numbers.push_back(level);
    if (numbers.empty() || !words.eof() ||
        std::none_of(factors.begin(), factors.end(),
                     [&](const Factor &factor) { return factor.name == name; }))
      throw UserError(
          path + ", line " + std::to_string(number) +
          ": give the name of an effect or nuisance of the study and numbers behind it.");
  }
  return result;
}

std::vector<Amplitudes> wanted_amplitudes(const std::vector<Factor> &factors, const Levels &given)
{
  std::vector<Amplitudes> result;
  for (const Factor &factor : factors)
    for (const double level : given.count(factor.name) > 0 ? given.at(factor.name) : levels(factor))
    {
      const double amplitude =
          std::clamp(factor.null_value + level * factor.scale, factor.lower, factor.upper);
      result.push_back({{factor.name, amplitude}});
    }
  return result;
}

void write_row(std::FILE *file, const RunRequest &request, const RunResult &result)
{
  std::fprintf(file, "%s ", request.experiment.c_str());
  if (request.amplitudes.empty())
    std::fprintf(file, "base 0");
  else
    std::fprintf(file, "%s %.6g", request.amplitudes.begin()->first.c_str(),
                 request.amplitudes.begin()->second);
  std::fprintf(file, " %u", request.seed);
  if (!result)
    std::fprintf(file, " failed");
  else
    for (const double value : *result)
      std::fprintf(file, " %.5g", value);
  std::fprintf(file, "\n");
}

void write_table(const std::string &path, const StudyInput &study, DemSimulator &simulator,
                 const std::vector<RunRequest> &requests)
{
  const std::vector<RunResult> results = simulator.run(requests);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    return;
  const std::string unfinished = path + ".unfinished";
  std::FILE *const file = std::fopen(unfinished.c_str(), "w");
  if (file == nullptr)
    throw UserError("Cannot write " + unfinished + ".");
  std::fprintf(file, "# Recorded runs of DEM simulations, made by record-runs: values of cells.\n");
  std::fprintf(file, "# version: %s\n# engine: %s\n", version(), engine_digest());
  for (const auto &[name, text] : study.identity())
    if (name != "engine" && name != "measured data")
      std::fprintf(file, "# sha256 of %s: %s\n", name.c_str(), sha256(text).c_str());
  for (const Factor &f : study.plain_factors())
    std::fprintf(file, "factor %s %s %.6g %.6g %.6g %.6g %s %.6g\n", f.name.c_str(),
                 f.kind == Factor::Kind::effect ? "effect" : "nuisance", f.null_value, f.scale,
                 f.lower, f.upper,
                 f.sign == Factor::Sign::above   ? "above"
                 : f.sign == Factor::Sign::below ? "below"
                                                 : "both",
                 f.prior_deviation);
  for (const Experiment &experiment : study.experiments) {
    std::fprintf(file, "cells %s %d", experiment.name().c_str(), experiment.is_held_out() ? 1 : 0);
    for (const DataPoint &point : simulator.data_points(experiment.name()))
      std::fprintf(file, " %s:%d", point.observable.c_str(), point.index);
    std::fprintf(file, "\n");
  }
  for (std::size_t k = 0; k < requests.size(); ++k)
    write_row(file, requests[k], results[k]);
  std::fclose(file);
  if (std::rename(unfinished.c_str(), path.c_str()) != 0)
    throw UserError("Cannot write " + path + ".");
}

void record(const std::string &study_file, const std::string &table, const unsigned int rounds,
            const unsigned int base_sets, const std::string &levels_file)
{
  Problems problems;
  const StudyInput study = read_study(study_file, {}, false, MPI_COMM_WORLD, problems);
  if (!problems.empty())
    throw UserError(problems);
  Log log(MPI_COMM_WORLD, false);
  DemSimulator simulator(study.experiments, study.factors, study.parameters.table_file(), 1,
                         MPI_COMM_WORLD, log);
  simulator.find_data_points(1);
  const std::vector<Amplitudes> others = wanted_amplitudes(
      study.plain_factors(),
      levels_file.empty() ? Levels() : read_levels(levels_file, study.plain_factors()));
  std::vector<RunRequest> requests;
  std::size_t n_written = 0;
  const auto add = [&](const Amplitudes &amplitudes, std::uint32_t seed) {
    for (const Experiment &experiment : study.experiments)
      requests.push_back({experiment.name(), amplitudes, seed});
    constexpr std::size_t runs_between_tables = 40;
    if (requests.size() < n_written + runs_between_tables)
      return;
    write_table(table, study, simulator, requests);
    n_written = requests.size();
  };
  for (unsigned int round = 0; round < rounds; ++round) {
    for (unsigned int k = 0; k < base_sets; ++k)
      add({}, 1 + round * base_sets + k);
    for (const Amplitudes &amplitudes : others)
      add(amplitudes, 1 + round);
    write_table(table, study, simulator, requests);
    log.line("Recorded " + std::to_string(round + 1) + " of " + std::to_string(rounds) +
             " rounds.");
  }
}

} // namespace

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  int code = 0;
  try {
    if (argc < 3)
      throw UserError("Usage: record-runs study.prm table.txt [rounds] [base sets a round] "
                      "[amplitudes]");
    stop_request::listen();
    record(argv[1], argv[2], argc > 3 ? static_cast<unsigned int>(std::atoi(argv[3])) : 4,
           argc > 4 ? static_cast<unsigned int>(std::atoi(argv[4])) : 10, argc > 5 ? argv[5] : "");
  } catch (const UserError &error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = 2;
  } catch (const Interrupted &) {
    code = 3;
  }
  return code;
}
