#ifndef eunoe_discovery_experiment_h
#define eunoe_discovery_experiment_h

#include <eunoe/discovery/catalogue.h>
#include <eunoe/discovery/simulator.h>
#include <eunoe/discovery/study_parameters.h>
#include <eunoe/simulation/parameters.h>

#include <mpi.h>

namespace eunoe::discovery {

class Experiment;

/// A request as it is run.
struct StudyCase
{
  const Experiment *experiment;
  std::vector<std::string> overrides;
  std::string key;     ///< hash of the entries that are not defaults, and of the files they name
  std::string problem; ///< why it cannot be run; empty if it can
  bool names_files = false;
  RunRequest request;
};

/// An experiment of a study: its base case, and the cases that come from it. All files are read
/// when it is made, so that afterwards each rank can make cases on its own.
class Experiment
{
public:
  /// What is wrong with the case goes to @p problems; collective.
  Experiment(const ExperimentParameters &parameters, MPI_Comm comm, Problems &problems);

  const std::string &name() const { return parameters.name; }
  bool is_held_out() const { return parameters.held_out; }
  /// Name of the process that is run, what is measured, and what the base case costs.
  const std::string &process_name() const { return process; }
  const RunEstimate &estimate() const { return cost; }
  const std::vector<ObservableDescription> &observables() const { return described; }
  /// Digests of the files that the base case names.
  const std::string &named_digests() const { return digests; }
  /// Warnings about the base case, which do not forbid the study.
  const std::vector<Problem> &doubts() const { return doubtful; }

  /// Overrides of the case file that put factors at amplitudes: the experiment's own, then
  /// nuisances, then effects, each in the order of names. A factor at its null value, or one that
  /// does not concern the process, leaves the case unchanged. Throws a UserError if a patch does
  /// not fit.
  std::vector<std::string> overrides(const std::vector<Effect> &factors,
                                     const Amplitudes &amplitudes) const;

  /// The case of a request. All ranks run it, or none if one of them cannot; collective.
  StudyCase make_case(const std::vector<Effect> &factors, const RunRequest &request,
                      MPI_Comm comm) const;

  /// The key that earlier versions gave such a case: a hash of the complete input with its
  /// comments, and of the files. Empty if the case cannot be run. Collective.
  std::string old_key(const std::vector<Effect> &factors, const RunRequest &request,
                      MPI_Comm comm) const;

  /// All from which the case of a request is made, as making it takes milliseconds: the texts of
  /// files, and overrides. Throws a UserError if a patch does not fit.
  std::string recipe(const std::vector<Effect> &factors, const RunRequest &request) const;

  /// What all entries of the base case are, as a text; the recipe by which a table of runs keeps
  /// what they were by an engine; and whether one that had another value by then is still there,
  /// as its default has changed.
  ///@{
  std::string all_entries() const;
  std::string recipe_of_entries(const std::string &engine) const;
  bool differs_from(const std::string &entries_by_then) const;
  ///@}

  /// The parameters of a case with these overrides.
  Parameters make(const std::vector<std::string> &overrides, Problems &problems) const;

private:
  /// Overrides of the case of a request, which is silent and has its own seeds.
  std::vector<std::string> run_overrides(const std::vector<Effect> &factors,
                                         const RunRequest &request) const;

  ExperimentParameters parameters;
  std::string process, digests;
  std::vector<ObservableDescription> described;
  RunEstimate cost;
  std::vector<Problem> doubtful;
  std::map<std::string, std::string> texts; ///< of the case file and those that it is made of
  EntryValues base;                         ///< all entries of the base case
};

/// A text that is the same for equal requests.
std::string text_of(const RunRequest &request);

/// Makes the factor for a nuisance of the study. Entries that are none go to @p problems.
Effect make_nuisance(const NuisanceParameters &parameters, Problems &problems);

} // namespace eunoe::discovery

#endif
