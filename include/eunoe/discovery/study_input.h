#ifndef eunoe_discovery_study_input_h
#define eunoe_discovery_study_input_h

#include <eunoe/discovery/experiment.h>
#include <eunoe/discovery/measured_data.h>
#include <eunoe/discovery/study_parameters.h>

namespace eunoe::discovery {

/// A study with all files that it names.
struct StudyInput
{
  StudyParameters parameters;
  std::vector<Experiment> experiments;
  std::vector<Effect> factors;       ///< effects that an experiment can have, then nuisances
  std::vector<std::string> left_out; ///< names of effects that no experiment can have
  MeasuredData data;
  std::string data_text; ///< the whole table

  std::vector<Factor> plain_factors() const { return {factors.begin(), factors.end()}; }

  /// All that decides the study's results, by name.
  std::map<std::string, std::string> identity() const;
};

/// Reads a study, its cases and its effects; collective. What is wrong goes to @p problems.
/// @param with_synthetic_data whether `subsection twin` may be there
StudyInput read_study(const std::string &file, const std::vector<std::string> &overrides,
                      bool with_synthetic_data, MPI_Comm comm, Problems &problems);

/// Reads its measured data.
void read_data(StudyInput &study, MPI_Comm comm, Problems &problems);

/// Notes effects and nuisances whose patches do not fit the cases at a clear amplitude.
void check_patches(const StudyInput &study, Problems &problems);

} // namespace eunoe::discovery

#endif
