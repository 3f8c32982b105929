#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/problems.h>
#include <eunoe/discovery/run_table.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <sqlite3.h>

namespace eunoe::discovery {

namespace {

/// A connection to the file; other programs may hold it for a while.
class Connection
{
public:
  explicit Connection(const std::string &file) : file(file)
  {
    constexpr int patience = 60000; // milliseconds
    check(sqlite3_open(file.c_str(), &base));
    check(sqlite3_busy_timeout(base, patience));
  }
  ~Connection() { sqlite3_close(base); }
  Connection(const Connection &) = delete;
  Connection &operator=(const Connection &) = delete;

  /// Runs a statement with texts in the places of its question marks.
  void run(const std::string &words, const std::vector<std::string> &values = {},
           const std::function<void(sqlite3_stmt *)> &on_row = {})
  {
    sqlite3_stmt *statement = nullptr;
    check(sqlite3_prepare_v2(base, words.c_str(), -1, &statement, nullptr));
    const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt *)> guard(statement, sqlite3_finalize);
    for (std::size_t k = 0; k < values.size(); ++k)
      check(sqlite3_bind_text(statement, static_cast<int>(k) + 1, values[k].c_str(), -1,
                              SQLITE_TRANSIENT));
    int state = sqlite3_step(statement);
    for (; state == SQLITE_ROW; state = sqlite3_step(statement))
      if (on_row)
        on_row(statement);
    if (state != SQLITE_DONE)
      check(state);
  }

private:
  void check(const int state)
  {
    if (state != SQLITE_OK)
      throw UserError("The table of runs " + file + " cannot be used: " +
                      (base == nullptr ? sqlite3_errstr(state) : sqlite3_errmsg(base)) +
                      ". Mend it, or name another 'table of runs'.");
  }

  const std::string file;
  sqlite3 *base = nullptr;
};

std::string text_at(sqlite3_stmt *statement, const int column)
{
  const unsigned char *const text = sqlite3_column_text(statement, column);
  return text == nullptr ? "" : std::string(text, text + sqlite3_column_bytes(statement, column));
}

} // namespace

std::string text_of(const std::vector<Measurement> &measurements)
{
  return eunoe::to_json(measurements).dump(); // JSON has no NaN; it becomes null
}

nlohmann::ordered_json to_json(const RunRecord &record)
{
  return {record.failure, record.core_seconds, eunoe::to_json(record.measurements)};
}

RunRecord record_from(const nlohmann::ordered_json &json)
{
  RunRecord record;
  record.failure = json.at(0).get<std::string>();
  record.core_seconds = json.at(1).get<double>();
  for (const auto &m : json.at(2))
    record.measurements.push_back({m.at(0).get<std::string>(), m.at(1).get<int>(),
                                   m.at(2).is_null() ? std::nan("") : m.at(2).get<double>()});
  return record;
}

void RunTable::open()
{
  const std::string folder = std::filesystem::path(file).parent_path().string();
  if (!folder.empty())
    create_folder(folder, comm);
  on_first_rank(comm, [&] {
    Connection(file).run(
        "CREATE TABLE IF NOT EXISTS runs (number INTEGER PRIMARY KEY, key TEXT NOT NULL, "
        "engine TEXT NOT NULL, experiment TEXT NOT NULL, amplitudes TEXT NOT NULL, "
        "seed INTEGER NOT NULL, state TEXT NOT NULL, message TEXT, \"values\" TEXT NOT NULL, "
        "core_seconds REAL NOT NULL, made TEXT DEFAULT CURRENT_TIMESTAMP, UNIQUE (key, engine))");
    Connection(file).run(
        "CREATE TABLE IF NOT EXISTS keys (recipe TEXT PRIMARY KEY, key TEXT NOT NULL)");
  });
}

std::vector<RunTable::Row> RunTable::rows() const
{
  std::string text;
  on_first_rank(comm, [&] {
    auto list = nlohmann::ordered_json::array();
    Connection(file).run(
        "SELECT number, key, engine, experiment, amplitudes, seed, message, core_seconds, "
        "\"values\" FROM runs ORDER BY number",
        {}, [&](sqlite3_stmt *s) {
          list.push_back({sqlite3_column_int64(s, 0),
                          text_at(s, 1),
                          text_at(s, 2),
                          text_at(s, 3),
                          nlohmann::ordered_json::parse(text_at(s, 4)),
                          sqlite3_column_int64(s, 5),
                          {text_at(s, 6), sqlite3_column_double(s, 7),
                           nlohmann::ordered_json::parse(text_at(s, 8))}});
        });
    text = list.dump();
  });
  std::vector<Row> result;
  for (const auto &json : nlohmann::ordered_json::parse(broadcast(text, comm)))
    result.push_back(Row{json.at(0),
                         json.at(1),
                         json.at(2),
                         {json.at(3), json.at(4).get<Amplitudes>(), json.at(5)},
                         record_from(json.at(6))});
  return result;
}

void RunTable::store(const Row &row) const
{
  Connection(file).run(
      "INSERT OR IGNORE INTO runs (key, engine, experiment, amplitudes, seed, state, message, "
      "\"values\", core_seconds) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {row.key, row.engine, row.request.experiment,
       nlohmann::ordered_json(row.request.amplitudes).dump(), std::to_string(row.request.seed),
       row.record.failure.empty() ? "done" : "failed", row.record.failure,
       text_of(row.record.measurements), std::to_string(row.record.core_seconds)});
}

std::map<std::string, std::string> RunTable::keys() const
{
  std::string text;
  on_first_rank(comm, [&] {
    auto all = nlohmann::json::object();
    Connection(file).run("SELECT recipe, key FROM keys", {},
                         [&](sqlite3_stmt *s) { all[text_at(s, 0)] = text_at(s, 1); });
    text = all.dump();
  });
  return nlohmann::json::parse(broadcast(text, comm));
}

void RunTable::store_keys(const std::map<std::string, std::string> &keys) const
{
  on_first_rank(comm, [&] {
    Connection connection(file);
    connection.run("BEGIN IMMEDIATE");
    for (const auto &[recipe, key] : keys)
      connection.run("INSERT OR IGNORE INTO keys VALUES (?, ?)", {recipe, key});
    connection.run("COMMIT");
  });
}

void RunTable::adopt(const std::vector<const Row *> &rows, const std::string &engine) const
{
  on_first_rank(comm, [&] {
    Connection connection(file);
    connection.run("BEGIN IMMEDIATE");
    for (const Row *const row : rows)
      connection.run("UPDATE OR IGNORE runs SET engine = ?, key = ? WHERE number = ?",
                     {engine, row->key, std::to_string(row->number)});
    connection.run("COMMIT");
  });
}

} // namespace eunoe::discovery
