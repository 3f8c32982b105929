#ifndef eunoe_core_problems_h
#define eunoe_core_problems_h

#include <stdexcept>
#include <string>
#include <vector>

namespace eunoe {

/// One thing that is wrong in the input, where it is, and how to mend it.
struct Problem
{
  std::string where; ///< file, line, subsection and entry
  std::string what;
  std::string mend;

  std::string text() const { return where + " " + what + (mend.empty() ? "" : " " + mend); }
};

/// All that is wrong in the input, collected so that a user sees it at once.
class Problems
{
public:
  void add(const std::string &where, const std::string &what, const std::string &mend)
  {
    list.push_back({where, what, mend});
  }
  void warn(const std::string &where, const std::string &what, const std::string &mend)
  {
    doubts.push_back({where, what, mend});
  }
  bool empty() const { return list.empty(); }
  const std::vector<Problem> &all() const { return list; }

  /// What is doubtful and does not forbid the run.
  const std::vector<Problem> &warnings() const { return doubts; }

  /// One line per problem.
  std::string text() const;

private:
  std::vector<Problem> list, doubts;
};

/// Thrown on every rank when a run cannot go on because of its input, its surroundings or its
/// particles; `what()` is ready to be shown to the user.
class UserError : public std::runtime_error
{
public:
  explicit UserError(const std::string &text) : std::runtime_error(text) {}
  explicit UserError(const Problems &problems) : std::runtime_error(problems.text()) {}
};

} // namespace eunoe

#endif
