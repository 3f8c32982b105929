#ifndef eunoe_discovery_results_h
#define eunoe_discovery_results_h

#include <eunoe/discovery/dem_simulator.h>
#include <eunoe/discovery/study_folder.h>
#include <eunoe/discovery/study_input.h>

namespace eunoe::discovery {

/// Writes, for every experiment, "model_before_<experiment>.prm" and
/// "model_after_<experiment>.prm", which eunoe-particles runs as they are, and
/// "model_<experiment>.diff", the entries in which they differ. Collective.
/// @param after amplitudes of the effects that the model lacked
void write_models(const StudyInput &study, const Amplitudes &after, const StudyFolder &folder);

/// Writes discovery.json: the answer, its provenance, and all runs. Collective.
void write_answer(const StudyInput &study, const Discovery &discovery,
                  const DemSimulator &simulator, const StudyFolder &folder);

/// Entries whose values differ, as an input file of the new ones with the old ones beside them.
std::string differences(const EntryValues &before, const EntryValues &after);

/// Command that makes discovery.html of a folder; empty if the script is not there.
std::string page_command(const std::string &folder);

/// Prints the warnings about a study, for `--check` and for the start of the study.
/// @return number of warnings
std::size_t print_doubts(const StudyInput &study, const Problems &problems, Log &log);

/// Prints what a study would cost, for `--check`.
void print_check(const StudyInput &study, std::size_t n_warnings, Log &log);

/// Prints the named effects and the path of the answer.
void print_answer(const Discovery &discovery, const StudyFolder &folder, Log &log);

} // namespace eunoe::discovery

#endif
