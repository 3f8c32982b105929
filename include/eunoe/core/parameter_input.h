#ifndef eunoe_core_parameter_input_h
#define eunoe_core_parameter_input_h

#include <eunoe/core/input_file.h>

namespace dealii {
class ParameterHandler;
}

namespace eunoe {

/// Subsections that are numbered, and the entry beside them that says how many there are.
struct RepeatedSections
{
  std::vector<std::string> path; ///< of the subsection around them
  std::string entry, prefix;     ///< "number of walls"; "wall" of "wall 0", "wall 1", ...
  unsigned int largest, standard;

  /// What the last of the entries says, or the standard.
  unsigned int count(const std::vector<InputEntry> &entries) const;
};

/// Gives values to declared parameters. What is unknown or does not fit goes to @p problems, with a
/// near name or with what would fit; every entry learns whether it says more than the default.
void set_entries(dealii::ParameterHandler &prm, std::vector<InputEntry> &entries,
                 const std::vector<RepeatedSections> &repeated, Problems &problems);

/// A complete, documented input file with the present values. Printing it takes longer than reading
/// an input does.
std::string complete_text(const dealii::ParameterHandler &prm);

/// The present values of all entries, as `values_in` finds them in the complete text.
EntryValues values_of(const dealii::ParameterHandler &prm);

/// The entries that name files which the run reads (`declare::file`), with their values.
EntryValues entries_naming_files(const dealii::ParameterHandler &prm);

/// All that is declared as JSON, in the order of declaration: for each section "entries", by name
/// with "default", "value" (what kind fits, in words; empty: any text) and "documentation", and
/// "subsections", by name. Other spellings of an entry are left out.
std::string describe_entries(const dealii::ParameterHandler &prm,
                             const std::vector<RepeatedSections> &repeated);

} // namespace eunoe

#endif
