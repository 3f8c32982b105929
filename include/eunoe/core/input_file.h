#ifndef eunoe_core_input_file_h
#define eunoe_core_input_file_h

#include <eunoe/core/problems.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace eunoe {

/// One "set entry = value" with its place.
struct InputEntry
{
  std::vector<std::string> path; ///< names of the subsections around it
  std::string name, value;       ///< without a name: the opening of the innermost subsection
  std::string where;             ///< "case.prm:12" or "--set"
  bool is_default = false;       ///< whether the value is what it would be without this line
};

/// Name of an entry for messages: "subsection 'a' / subsection 'b' / entry 'c'".
std::string describe(const std::vector<std::string> &path, const std::string &entry);

/// Gives the text of a file that an input includes or names; throws a UserError if it cannot be
/// read.
using FileLoader = std::function<std::string(const std::string &path)>;

/// Splits the text of a `.prm` file into its entries; what is not understood is added to
/// @p problems with its line. Understands what ParameterHandler understands: comments, `set`,
/// `subsection`, `end`, lines continued by a backslash, and `include file`, where the file's place
/// is relative to the one that includes it.
std::vector<InputEntry> parse_input(const std::string &text, const std::string &file,
                                    Problems &problems, const FileLoader &load = {});

/// Values of entries by subsections and name.
using EntryValues = std::map<std::pair<std::vector<std::string>, std::string>, std::string>;

/// What a complete and correct text says.
EntryValues values_in(const std::string &text);

/// One "subsection/.../entry = value" from the command line.
InputEntry parse_override(const std::string &text, Problems &problems);

/// The entries of a text, then those of overrides from the command line, in their order.
std::vector<InputEntry> parse_input_and_overrides(const std::string &text, const std::string &file,
                                                  const std::vector<std::string> &overrides,
                                                  Problems &problems, const FileLoader &load);

/// Whether a text can go into files in JSON, which are UTF-8 throughout.
bool is_utf8(const std::string &text);

/// The candidate that is most like @p word, empty if none is near.
std::string nearest_name(const std::string &word, const std::vector<std::string> &candidates);

} // namespace eunoe

#endif
