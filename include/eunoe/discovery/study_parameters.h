#ifndef eunoe_discovery_study_parameters_h
#define eunoe_discovery_study_parameters_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/discovery/study.h>

namespace eunoe::discovery {

/// `subsection experiment k`: a case of eunoe-particles whose results were measured.
struct ExperimentParameters
{
  std::string name, case_file;
  std::vector<std::string> overrides; ///< "subsection/entry = value"
  bool held_out = false;
};

/// `subsection nuisance k`: a parameter of the base model that is known only with an uncertainty.
struct NuisanceParameters
{
  std::string name;
  std::vector<std::string> entries;          ///< "subsection/entry", all get the value
  std::string value = "${base + amplitude}"; ///< as in an effect's patch
  double standard_deviation = 0.;            ///< of the amplitude, whose mean is zero
};

/// `subsection twin`: the truth of a twin experiment, from which synthetic data are made.
struct SyntheticDataParameters
{
  std::vector<std::string> effects; ///< "name: amplitude"
  std::vector<std::string> overrides;
  std::vector<std::string> observables = {"all"}; ///< in the table of data
  std::string sealed_file = "truth.sealed.json";
  unsigned int seed = 1001, repeats = 4;
  double noise = 0.01, time_step_factor = 0.8;
  bool jitter_nuisances = true;
};

/// Everything that a study file says.
class StudyParameters
{
public:
  /// Reads a study file, then the overrides; all that is wrong goes to @p problems. Files that it
  /// names are meant relative to the file in which their entry stands, those of overrides relative
  /// to the folder in which the program was started.
  /// @param with_synthetic_data whether `subsection twin` may be there
  static StudyParameters read(const std::string &text, const std::string &file,
                              const std::vector<std::string> &overrides, bool with_synthetic_data,
                              Problems &problems, const FileLoader &load = {});

  /// A complete, documented study file with the same content.
  const std::string &as_input_file() const { return complete_input; }

  /// All entries, with one of each of the numbered subsections: see describe_entries.
  static std::string description();

  /// File in which simulations are kept.
  std::string table_file() const;

  std::string measured_data = "measured.csv", output_path = "./output";
  std::string table_of_runs; ///< as written; empty: beside the output folder
  std::vector<std::string> effects = {"all"}, excluded_effects, effect_folders;
  StudyOptions options;
  unsigned int ranks_per_run = 1;
  bool write_page = true;
  std::vector<ExperimentParameters> experiments;
  std::vector<NuisanceParameters> nuisances;
  SyntheticDataParameters synthetic;

private:
  void declare(dealii::ParameterHandler &prm, bool with_synthetic_data);
  void check(const ParameterCheck &check) const;

  std::string complete_input;
};

} // namespace eunoe::discovery

#endif
