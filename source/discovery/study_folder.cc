#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/sha256.h>
#include <eunoe/discovery/study_folder.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <filesystem>

namespace eunoe::discovery {

namespace fs = std::filesystem;

namespace {

const std::string identity_file = "study.json";

/// The text of a file on the first rank, given to all; nothing if there is none.
std::optional<nlohmann::ordered_json> read_json(const std::string &file, MPI_Comm comm)
{
  std::error_code failure;
  const std::string is_there =
      broadcast(is_first_rank(comm) && fs::exists(file, failure) ? "yes" : "", comm);
  if (is_there.empty())
    return std::nullopt;
  try {
    return nlohmann::ordered_json::parse(read_file(file, comm));
  } catch (const nlohmann::json::exception &) {
    throw UserError(file + " is damaged. Remove it; the runs are kept in their table.");
  }
}

} // namespace

std::string StudyFolder::file(const std::string &name) const
{
  return (fs::path(path) / name).lexically_normal().string();
}

std::optional<std::int64_t> StudyFolder::open(const std::map<std::string, std::string> &identity,
                                              const std::int64_t last_row)
{
  const std::string began = "last row of the table at the start";
  create_folder(path, comm);
  lock = std::make_unique<RunLock>(file("running.lock"), "The folder " + path,
                                   "Wait until it ends, or choose another 'output path'.", comm);
  nlohmann::ordered_json mine;
  for (const auto &[name, text] : identity)
    mine[name] = sha256(text);
  const auto before = read_json(file(identity_file), comm);
  if (!before) {
    mine[began] = last_row;
    write(identity_file, mine.dump(1) + "\n");
    return std::nullopt;
  }
  std::vector<std::string> differ;
  for (const auto &[name, digest] : mine.items())
    if (!before->contains(name) || before->at(name) != digest)
      differ.push_back(name);
  for (const auto &[name, digest] : before->items())
    if (!mine.contains(name) && name != began)
      differ.push_back(name);
  if (!differ.empty())
    throw UserError("The folder " + path +
                    " holds another study; what differs: " + boost::join(differ, ", ") +
                    ". Choose another 'output path', or remove the folder. (With the same 'table "
                    "of runs' no run is made twice.)");
  return before->value(began, std::int64_t(0));
}

void StudyFolder::write_csv(const std::string &name, const nlohmann::ordered_json &list) const
{
  const std::string csv = as_csv(list);
  if (!csv.empty())
    write(name, csv);
  else if (is_first_rank(comm))
    remove_file(file(name)); // that of an earlier answer
}

void StudyFolder::write(const std::string &name, const std::string &text) const
{
  on_first_rank(comm, [&] { write_file(file(name), text); });
}

std::string as_csv(const nlohmann::ordered_json &list)
{
  if (!list.is_array() || list.empty() ||
      !std::all_of(list.begin(), list.end(), [](const auto &row) { return row.is_object(); }))
    return "";
  std::vector<std::string> columns;
  for (const auto &row : list)
    for (const auto &[name, value] : row.items())
      if (value.is_primitive() && std::find(columns.begin(), columns.end(), name) == columns.end())
        columns.push_back(name);
  if (columns.empty())
    return "";
  std::string text = boost::join(columns, ",") + "\n";
  for (const auto &row : list) {
    std::vector<std::string> words;
    for (const std::string &column : columns) {
      const auto value = row.find(column);
      words.push_back(value == row.end() || !value->is_primitive() || value->is_null() ? ""
                      : value->is_string() ? value->template get<std::string>()
                                           : value->dump());
      if (words.back().find_first_of(",\"") != std::string::npos)
        words.back() = "\"" + boost::replace_all_copy(words.back(), "\"", "\"\"") + "\"";
    }
    text += boost::join(words, ",") + "\n";
  }
  return text;
}

} // namespace eunoe::discovery
