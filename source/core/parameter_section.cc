#include <eunoe/core/parameter_section.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace eunoe {

const InputEntry *ParameterCheck::find(const Path &path, const std::string &entry) const
{
  // A later line overrides an earlier one, hence from the back.
  const auto it = std::find_if(entries.rbegin(), entries.rend(), [&](const InputEntry &e) {
    return e.path == path && e.name == entry;
  });
  return it == entries.rend() ? nullptr : &*it;
}

bool ParameterCheck::is_changed(const Path &path, const std::string &entry) const
{
  const InputEntry *const set = find(path, entry);
  return set != nullptr && !set->is_default;
}

bool ParameterCheck::is_changed_beside(const Path &path, const std::string &entry,
                                       const std::string &choice) const
{
  if (!is_changed(path, entry))
    return false;
  const InputEntry *const set = find(path, entry), *const chosen = find(path, choice);
  // "case.prm:12"
  const auto file_of = [](const InputEntry &e) { return e.where.substr(0, e.where.rfind(':')); };
  return chosen == nullptr || set > chosen || file_of(*set) == file_of(*chosen);
}

bool ParameterCheck::has_changes(const std::string &subsection) const
{
  return std::any_of(entries.begin(), entries.end(), [&](const InputEntry &entry) {
    return !entry.path.empty() && entry.path.front() == subsection &&
           is_changed(entry.path, entry.name);
  });
}

std::string ParameterCheck::place(const Path &path, const std::string &entry) const
{
  const InputEntry *const set = find(path, entry);
  const std::string name = describe(path, entry);
  return (set ? set->where : file) + (name.empty() ? "" : ": " + name) +
         (set || entry.empty() ? "" : " (left at its default)");
}

void ParameterCheck::require(const bool ok, const Path &path, const std::string &entry,
                             const std::string &what, const std::string &mend) const
{
  if (!ok)
    problems.add(place(path, entry), what, mend);
}

void ParameterCheck::advise(const bool ok, const Path &path, const std::string &entry,
                            const std::string &what, const std::string &mend) const
{
  if (!ok)
    problems.warn(place(path, entry), what, mend);
}

std::string format(const double value)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string format_whole(const double value)
{
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) < 1e15 ? "%.0f" : "%.6g", std::round(value));
  return text;
}

std::string format_count(const double value, const std::string &singular, const std::string &plural)
{
  const std::string number = format_whole(value);
  return number + " " + (number == "1" ? singular : plural);
}

std::string format_roughly(const double value)
{
  if (value >= 10.)
    return format_whole(value);
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

} // namespace eunoe
