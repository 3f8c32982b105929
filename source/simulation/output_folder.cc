#include <eunoe/checkpoint/head_values.h>
#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/new_file.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/simulation/output_folder.h>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace eunoe {

std::string OutputFolder::open()
{
  create_folder(path, comm);
  lock = std::make_unique<RunLock>(
      file("running.lock"), "The folder " + shortened(path),
      "Wait until it ends, or stop it, or choose another 'output path'.", comm);
  opened = true;
  return lock->weakness();
}

void OutputFolder::write(const std::string &name, const std::string &text) const
{
  if (!opened)
    return;
  written.insert(name);
  on_first_rank(comm, [&] { write_file(file(name), text); });
}

void OutputFolder::remove_old(const std::vector<std::string> &names) const
{
  if (opened)
    on_first_rank(comm, [&] {
      std::error_code failure;
      for (const std::string &name : names)
        if (written.count(name) == 0 && tables.count(name) == 0 && sizes_before.count(name) == 0 &&
            std::filesystem::is_regular_file(
                std::filesystem::symlink_status(file(name), failure))) // no link of the user's
          remove_file(file(name));
    });
}

void OutputFolder::write_in_parts(const std::string &name, const std::string &mine) const
{
  if (opened)
    eunoe::write_in_parts(file(name), mine, comm);
}

std::shared_ptr<CsvFile> OutputFolder::table(const std::string &name,
                                             const std::vector<std::string> &columns)
{
  const auto before = sizes_before.find(name);
  tables[name] = std::make_shared<CsvFile>(opened ? file(name) : "", columns, comm,
                                           before == sizes_before.end() ? 0 : before->second);
  return tables[name];
}

std::shared_ptr<PictureSeries> OutputFolder::pictures(const std::string &name)
{
  series[name] = std::make_shared<PictureSeries>(opened ? path : "", name, comm);
  const auto before = files_before.find(name);
  if (before != files_before.end())
    series[name]->resume(before->second);
  return series[name];
}

nlohmann::ordered_json OutputFolder::save() const
{
  nlohmann::ordered_json saved;
  saved["tables"] = nlohmann::ordered_json::object();
  saved["pictures"] = nlohmann::ordered_json::object();
  // Those that this part of the run does not write are continued by a later one.
  saved["tables"].update(nlohmann::ordered_json(sizes_before));
  saved["pictures"].update(nlohmann::ordered_json(files_before));
  for (const auto &[name, table] : tables)
    saved["tables"][name] = table->size();
  for (const auto &[name, pictures] : series)
    if (!pictures->get_files().empty())
      saved["pictures"][name] = pictures->get_files();
  return saved;
}

void OutputFolder::sync()
{
  if (!opened)
    return;
  // What a rank has written may wait in the memory of its node.
  on_every_rank(comm, [&] {
    for (const auto &[name, pictures] : series)
      pictures->sync();
  });
  on_first_rank(comm, [&] {
    for (const auto &[name, table] : tables)
      table->sync();
    sync_folder_of(file(""));
  });
}

void OutputFolder::resume(const nlohmann::ordered_json &saved)
{
  for (const auto &[name, size] : saved.at("tables").items())
    sizes_before[name] = count_in(size);
  files_before = saved.at("pictures").get<std::map<std::string, PictureSeries::Files>>();
}

} // namespace eunoe
