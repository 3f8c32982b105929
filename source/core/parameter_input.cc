#include <eunoe/core/parameter_input.h>
#include <eunoe/core/quoted_text.h>

#include <deal.II/base/parameter_handler.h>

#include "values_in_words.h"
#include <boost/property_tree/json_parser.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <sstream>

namespace eunoe {

namespace {

using Path = std::vector<std::string>;

/// Names of the entries and subsections of one level, for suggestions.
struct Level
{
  std::vector<std::string> entries, subsections;
};

/// What a handler would save of itself, of which only the tree of its entries is looked at. Asking
/// the handler for an entry that is not declared would end a Debug build.
struct TreeOfEntries
{
  explicit TreeOfEntries(const dealii::ParameterHandler &prm) { prm.save(*this, 0); }

  TreeOfEntries &operator&(const boost::property_tree::ptree &entries)
  {
    tree = &entries;
    return *this;
  }
  template <typename Other>
  TreeOfEntries &operator&(const Other &)
  {
    return *this;
  }

  const boost::property_tree::ptree *tree = nullptr;
};

/// The key of a name in that tree: letters and digits as they are, of all else the code.
std::string key_of(const std::string &name)
{
  constexpr char digits[] = "0123456789abcdef";
  std::string key;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 && name != "value")
      key += c;
    else
      key += {'_', digits[static_cast<unsigned char>(c) / 16],
              digits[static_cast<unsigned char>(c) % 16]};
  return key;
}

/// The name of a key.
std::string name_of(const std::string &key)
{
  std::string name;
  for (std::size_t k = 0; k < key.size(); ++k)
    if (key[k] == '_') {
      name += static_cast<char>(std::stoi(key.substr(k + 1, 2), nullptr, 16));
      k += 2;
    } else
      name += key[k];
  return name;
}

/// Adds the values of those entries of a section of that tree whose kind is wanted.
/// @param path of the section
/// @param kind a part of the description of their pattern
void add_values(const boost::property_tree::ptree &section, const std::string &kind, Path &path,
                EntryValues &found)
{
  for (const auto &[key, child] : section)
    if (child.count("value") > 0) {
      if (kind.empty() ||
          child.get<std::string>("pattern_description").find(kind) != std::string::npos)
        found[{path, name_of(key)}] = child.get<std::string>("value");
    } else if (child.count("alias") == 0) {
      path.push_back(name_of(key));
      add_values(child, kind, path, found);
      path.pop_back();
    }
}

EntryValues values_of_kind(const dealii::ParameterHandler &prm, const std::string &kind)
{
  EntryValues found;
  Path path;
  add_values(*TreeOfEntries(prm).tree, kind, path, found);
  return found;
}

/// The value of an entry; none of one that is not declared by this name.
std::optional<std::string> value_of(const boost::property_tree::ptree &entries, const Path &path,
                                    const std::string &name)
{
  const boost::property_tree::ptree *node = &entries;
  for (const std::string &section : path) {
    const auto child = node->find(key_of(section));
    if (child == node->not_found())
      return std::nullopt;
    node = &child->second;
  }
  const auto entry = node->find(key_of(name));
  if (entry == node->not_found() || entry->second.count("value") == 0)
    return std::nullopt;
  return entry->second.get<std::string>("value");
}

/// What is declared, by subsections.
boost::property_tree::ptree tree_of(
    const dealii::ParameterHandler &prm,
    const dealii::ParameterHandler::OutputStyle order = dealii::ParameterHandler::DefaultStyle)
{
  std::ostringstream json;
  prm.print_parameters(json, dealii::ParameterHandler::JSON | order);
  std::istringstream stream(json.str());
  boost::property_tree::ptree tree;
  boost::property_tree::read_json(stream, tree);
  return tree;
}

/// Whether a node is an entry; a section may have one with the name 'value'.
bool is_entry(const boost::property_tree::ptree &node)
{
  return node.count("default_value") > 0;
}

Level look_at(const boost::property_tree::ptree &tree, const Path &path)
{
  const boost::property_tree::ptree *node = &tree;
  for (const std::string &name : path)
    for (const auto &child : *node)
      if (child.first == name) {
        node = &child.second;
        break;
      }
  Level level;
  for (const auto &[name, child] : *node)
    (is_entry(child) || child.count("alias") > 0 ? level.entries : level.subsections)
        .push_back(name);
  return level;
}

std::string suggestion(const std::string &word, const std::vector<std::string> &candidates)
{
  const std::string near = nearest_name(word, candidates);
  return near.empty() ? "" : "Did you mean '" + near + "'?";
}

nlohmann::ordered_json description_of(const boost::property_tree::ptree &section)
{
  nlohmann::ordered_json description = {{"entries", nlohmann::ordered_json::object()},
                                        {"subsections", nlohmann::ordered_json::object()}};
  for (const auto &[name, child] : section)
    if (is_entry(child))
      description["entries"][name] = {
          {"default", child.get<std::string>("default_value")},
          {"value", in_words(child.get<std::string>("pattern_description"))},
          {"documentation", child.get<std::string>("documentation")}};
    else if (child.count("alias") == 0)
      description["subsections"][name] = description_of(child);
  return description;
}

} // namespace

unsigned int RepeatedSections::count(const std::vector<InputEntry> &entries) const
{
  unsigned int number = standard;
  for (const InputEntry &e : entries)
    if (e.path == path && e.name == entry) {
      char *end;
      const long n = std::strtol(e.value.c_str(), &end, 10);
      // Values that are not numbers are reported when they are set.
      if (*end == '\0' && n >= 0 && n <= static_cast<long>(largest))
        number = static_cast<unsigned int>(n);
    }
  return number;
}

namespace {

/// Sets one entry after another and says what is wrong with them.
class EntrySetter
{
public:
  EntrySetter(dealii::ParameterHandler &prm, const std::vector<RepeatedSections> &repeated,
              Problems &problems)
      : prm(prm), entries(*TreeOfEntries(prm).tree), repeated(repeated), problems(problems)
  {
  }

  void set(const InputEntry &entry)
  {
    if (!find_section(entry) || entry.name.empty())
      return;
    for (const std::string &name : entry.path)
      prm.enter_subsection(name);
    const std::string place = entry.where + ": " + describe(entry.path, entry.name);
    bool declared = true;
    try {
      const auto place_of_entry = std::pair(entry.path, entry.name);
      if (defaults.count(place_of_entry) == 0)
        if (const auto value = value_of(entries, entry.path, entry.name))
          defaults[place_of_entry] = *value;
      prm.set(entry.name, entry.value);
    } catch (const dealii::ParameterHandler::ExcEntryUndeclared &) {
      declared = false;
    } catch (const std::exception &error) {
      refuse(place, entry.value, wanted_by(error.what()));
    }
    for (std::size_t k = 0; k < entry.path.size(); ++k)
      prm.leave_subsection();
    const std::string lookalike = declared ? "" : advice_on_lookalikes(entry.name);
    if (!declared)
      problems.add(place, "is unknown.",
                   !lookalike.empty() ? lookalike
                                      : suggestion(entry.name, known_at(entry.path).entries));
  }

  /// Whether an entry has the value that was declared, however lists are spaced. That of an entry
  /// under another name is not known here.
  bool is_default(const InputEntry &entry) const
  {
    const auto declared = defaults.find({entry.path, entry.name});
    const auto value = value_of(entries, entry.path, entry.name);
    return declared != defaults.end() && value && is_same(*value, declared->second);
  }

private:
  /// Whether two texts are the same number, or the same but for blanks.
  static bool is_same(std::string a, std::string b)
  {
    for (std::string *const text : {&a, &b})
      text->erase(std::remove(text->begin(), text->end(), ' '), text->end());
    const auto number_in = [](const std::string &text) -> std::optional<double> {
      char *end = nullptr;
      const double number = std::strtod(text.c_str(), &end);
      return !text.empty() && *end == '\0' ? std::optional(number) : std::nullopt;
    };
    const std::optional<double> of_a = number_in(a), of_b = number_in(b);
    return a == b || (of_a && of_b && *of_a == *of_b);
  }

  Level known_at(const Path &path)
  {
    if (tree.empty())
      tree = tree_of(prm);
    return look_at(tree, path);
  }

  /// Whether the subsections of an entry exist; the first that does not is reported once.
  bool find_section(const InputEntry &entry)
  {
    Path known;
    for (const std::string &name : entry.path) {
      Path next = known;
      next.push_back(name);
      if (!prm.subsection_path_exists(next)) {
        if (!reported.insert(next).second)
          return false;
        std::string mend = advice_on_lookalikes(name);
        if (mend.empty())
          mend = suggestion(name, known_at(known).subsections);
        for (const RepeatedSections &r : repeated)
          if (r.path == known && name.compare(0, r.prefix.size(), r.prefix) == 0)
            mend = "Raise '" + r.entry + "', or remove the subsection.";
        problems.add(entry.where + ": " + describe(next, ""), "is unknown.", mend);
        return false;
      }
      known = next;
    }
    return true;
  }

  /// @param wanted what the entry asks for, in words
  void refuse(const std::string &place, const std::string &value, const std::string &wanted)
  {
    const std::string mistake = usual_mistake(value, wanted);
    problems.add(place,
                 value.empty() ? "has no value."
                               : "is '" + shortened(value) + "', which does not fit.",
                 (wanted.empty() ? "" : "Give " + with_limit(wanted, value) + ".") +
                     (wanted.empty() || mistake.empty() ? "" : " ") + mistake);
  }

  dealii::ParameterHandler &prm;
  const boost::property_tree::ptree &entries; ///< of the handler, with their present values
  const std::vector<RepeatedSections> &repeated;
  Problems &problems;
  std::map<std::pair<Path, std::string>, std::string> defaults; ///< of the entries that were set
  std::set<Path> reported;
  boost::property_tree::ptree tree; // made when the first name is unknown
};

} // namespace

void set_entries(dealii::ParameterHandler &prm, std::vector<InputEntry> &entries,
                 const std::vector<RepeatedSections> &repeated, Problems &problems)
{
  EntrySetter setter(prm, repeated, problems);
  for (const InputEntry &entry : entries)
    setter.set(entry);
  for (InputEntry &entry : entries) {
    entry.is_default = entry.name.empty() || setter.is_default(entry);
    // Numbers of subsections are known before they are declared.
    for (const RepeatedSections &r : repeated)
      if (entry.path == r.path && entry.name == r.entry)
        entry.is_default = entry.value == std::to_string(r.standard);
  }
}

std::string complete_text(const dealii::ParameterHandler &prm)
{
  std::ostringstream text;
  prm.print_parameters(text, dealii::ParameterHandler::PRM);
  return text.str();
}

EntryValues values_of(const dealii::ParameterHandler &prm)
{
  return values_of_kind(prm, "");
}

EntryValues entries_naming_files(const dealii::ParameterHandler &prm)
{
  // Of one file, or of a list.
  return values_of_kind(prm, dealii::Patterns::FileName().description());
}

std::string describe_entries(const dealii::ParameterHandler &prm,
                             const std::vector<RepeatedSections> &repeated)
{
  nlohmann::ordered_json description =
      description_of(tree_of(prm, dealii::ParameterHandler::KeepDeclarationOrder));
  for (const RepeatedSections &r : repeated) {
    nlohmann::ordered_json *section = &description;
    for (const std::string &name : r.path)
      section = &section->at("subsections").at(name);
    // The declared default is the number of subsections.
    section->at("entries").at(r.entry).at("default") = std::to_string(r.standard);
  }
  return description.dump(1);
}

} // namespace eunoe
