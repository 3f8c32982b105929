#ifndef eunoe_core_parameter_section_h
#define eunoe_core_parameter_section_h

#include <eunoe/core/input_file.h>

namespace dealii {
class ParameterHandler;
}

namespace eunoe {

/// Collects what is wrong with the values of a set of parameters, with the place where the user
/// wrote each.
class ParameterCheck
{
public:
  using Path = std::vector<std::string>;

  /// @param file name of the input file, for entries that it leaves at their default
  ParameterCheck(const std::vector<InputEntry> &entries, const std::string &file,
                 Problems &problems)
      : entries(entries), file(file), problems(problems)
  {
  }

  /// Notes a problem unless @p ok.
  /// @param what completes the sentence "<place> ...", for example "is -1, which is not positive."
  /// @param mend a sentence that says what to do
  void require(bool ok, const Path &path, const std::string &entry, const std::string &what,
               const std::string &mend) const;

  /// Likewise for what is doubtful and does not forbid the run.
  void advise(bool ok, const Path &path, const std::string &entry, const std::string &what,
              const std::string &mend) const;

  /// Whether the user set an entry to something else than its default.
  bool is_changed(const Path &path, const std::string &entry) const;

  /// Whether the user wrote an entry at all.
  bool is_written(const Path &path, const std::string &entry) const
  {
    return find(path, entry) != nullptr;
  }

  /// Whether the user changed an entry although another one, the choice, leaves it without effect:
  /// in the file that makes the choice, or behind it. What an included file says before a later
  /// choice is meant for the cases that keep to its own.
  bool is_changed_beside(const Path &path, const std::string &entry,
                         const std::string &choice) const;

  /// Whether the user changed any entry in a subsection of the top level.
  bool has_changes(const std::string &subsection) const;

private:
  std::string place(const Path &path, const std::string &entry) const;
  const InputEntry *find(const Path &path, const std::string &entry) const;

  const std::vector<InputEntry> &entries;
  const std::string file;
  Problems &problems;
};

/// A group of parameters that declares itself: a plain struct with one line an entry.
class ParameterSection
{
public:
  virtual ~ParameterSection() = default;

  /// Declares every entry with its default, pattern and documentation, and ties it to a member.
  virtual void declare(dealii::ParameterHandler &prm) = 0;

  /// Looks for values that are no sense, alone or together.
  virtual void check(const ParameterCheck &) const {}
};

/// A number as a user would write it.
std::string format(double value);

/// An estimate of a number of things: whole, without an exponent as far as it is exact.
std::string format_whole(double value);

/// With its noun: "1 picture", "12 pictures".
std::string format_count(double value, const std::string &singular, const std::string &plural);

/// A rough estimate: two digits, and whole from 10 up.
std::string format_roughly(double value);

} // namespace eunoe

#endif
