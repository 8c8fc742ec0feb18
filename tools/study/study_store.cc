#include "tools/study/study_store.h"

#include <sqlite3.h>

#include "scenarios/input_error.h"

namespace plumbline {
namespace {

constexpr int kSchemaVersion = 1;
constexpr int kApplicationId = 0x504c4d42;  // "PLMB"
constexpr int kPatience_ms = 5'000;         // while a report reads

constexpr const char* kSchema = R"sql(
CREATE TABLE property (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID, STRICT;
CREATE TABLE run (
  key TEXT PRIMARY KEY, outcome TEXT NOT NULL, reason TEXT NOT NULL, result TEXT NOT NULL, output TEXT NOT NULL,
  wall_s REAL NOT NULL, cpu_s REAL NOT NULL, peak_memory_mb REAL NOT NULL
) WITHOUT ROWID, STRICT;
)sql";

[[noreturn]] void fail_damaged(const std::filesystem::path& path, const std::string& said) {
  throw InputError(path.string() + ": damaged database: " + said +
                   "; move this file away and --resume takes over the finished runs from their directories");
}

/// What SQLite says, and what to do about it.
[[noreturn]] void fail(sqlite3* database, const std::filesystem::path& path) {
  const int code = database != nullptr ? sqlite3_errcode(database) & 0xff : SQLITE_NOMEM;
  const std::string said = database != nullptr ? sqlite3_errmsg(database) : "out of memory";
  const bool damaged = code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
  throw InputError(
      path.string() + (damaged ? ": damaged database: " : ": cannot be used: ") + said +
      (damaged ? "; move this file away and --resume takes over the finished runs from their directories" : ""));
}

/// A prepared statement; text parameters are numbered from 1.
class Statement {
 public:
  Statement(sqlite3* database, const std::filesystem::path& path, const char* sql) : database_(database), path_(path) {
    if (sqlite3_prepare_v2(database, sql, -1, &statement_, nullptr) != SQLITE_OK) fail(database, path);
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(int index, const std::string& text) {
    sqlite3_bind_text64(statement_, index, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    return *this;
  }
  Statement& bind(int index, double number) {
    sqlite3_bind_double(statement_, index, number);
    return *this;
  }
  /// @returns whether there is a row
  bool step() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) fail(database_, path_);
    return code == SQLITE_ROW;
  }
  std::string text(int column) const {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_, column));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
    return size == 0 ? std::string() : std::string(bytes, size);
  }
  double number(int column) const { return sqlite3_column_double(statement_, column); }

 private:
  sqlite3* database_;
  const std::filesystem::path& path_;
  sqlite3_stmt* statement_ = nullptr;
};

void execute(sqlite3* database, const std::filesystem::path& path, const std::string& sql) {
  if (sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail(database, path);
}

int integer_pragma(sqlite3* database, const std::filesystem::path& path, const char* sql) {
  Statement statement(database, path, sql);
  return statement.step() ? static_cast<int>(statement.number(0)) : 0;
}

void create_schema(sqlite3* database, const std::filesystem::path& path) {
  execute(database, path,
          std::string("BEGIN IMMEDIATE;") + kSchema + "PRAGMA application_id=" + std::to_string(kApplicationId) +
              ";PRAGMA user_version=" + std::to_string(kSchemaVersion) + ";COMMIT;");
}

void check_schema(sqlite3* database, const std::filesystem::path& path) {
  if (integer_pragma(database, path, "PRAGMA application_id") != kApplicationId) {
    throw InputError(path.string() + ": a database, but not one of plumbline's");
  }
  const int version = integer_pragma(database, path, "PRAGMA user_version");
  if (version != kSchemaVersion) {
    throw InputError(path.string() + ": found schema version " + std::to_string(version) + ", this program knows " +
                     std::to_string(kSchemaVersion));
  }
  Statement check(database, path, "PRAGMA quick_check(1)");
  if (check.step() && check.text(0) != "ok") fail_damaged(path, check.text(0));
}

}  // namespace

void StudyStore::Closer::operator()(sqlite3* database) const { sqlite3_close(database); }

StudyStore::StudyStore(const std::filesystem::path& path) : path_(path) {
  sqlite3* database = nullptr;
  const int code = sqlite3_open(path.c_str(), &database);
  database_.reset(database);
  if (code != SQLITE_OK) fail(database, path_);
  sqlite3_busy_timeout(database, kPatience_ms);
  execute(database, path_, "PRAGMA journal_mode=DELETE;PRAGMA synchronous=FULL;");
  const bool is_new = integer_pragma(database, path_, "SELECT count(*) FROM sqlite_schema") == 0;
  if (is_new) {
    create_schema(database, path_);
  } else {
    check_schema(database, path_);
  }
}

std::optional<std::string> StudyStore::property(const std::string& name) const {
  Statement select(database_.get(), path_, "SELECT value FROM property WHERE name=?1");
  select.bind(1, name);
  if (!select.step()) return std::nullopt;
  return select.text(0);
}

void StudyStore::set_property(const std::string& name, const std::string& value) {
  Statement insert(database_.get(), path_, "INSERT OR REPLACE INTO property VALUES (?1, ?2)");
  insert.bind(1, name).bind(2, value).step();
}

void StudyStore::add(const StoredRun& run) {
  Statement insert(database_.get(), path_, "INSERT OR REPLACE INTO run VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)");
  insert.bind(1, run.key).bind(2, run.outcome).bind(3, run.reason).bind(4, run.result).bind(5, run.output);
  insert.bind(6, run.wall_s).bind(7, run.cpu_s).bind(8, run.peak_memory_mb).step();
}

void StudyStore::clear() {
  execute(database_.get(), path_, "BEGIN IMMEDIATE;DELETE FROM run;DELETE FROM property;COMMIT;");
}

std::vector<StoredRun> StudyStore::runs() const {
  Statement select(database_.get(), path_,
                   "SELECT key, outcome, reason, result, output, wall_s, cpu_s, peak_memory_mb FROM run ORDER BY key");
  std::vector<StoredRun> runs;
  while (select.step()) {
    runs.push_back({select.text(0), select.text(1), select.text(2), select.text(3), select.text(4), select.number(5),
                    select.number(6), select.number(7)});
  }
  return runs;
}

}  // namespace plumbline
