#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct sqlite3;

namespace plumbline {

/// What is known of one run that has ended, however it ended.
struct StoredRun {
  std::string key;
  std::string outcome;  ///< finished, refused, crashed, time_limit or memory_limit
  std::string reason;   ///< in words, without wall-clock figures; empty when there is nothing to explain
  std::string result;   ///< the text of result.json; empty when the run wrote none
  std::string output;   ///< the last it printed, of a run without a result
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_memory_mb = 0.0;
};

/// The one file that says what a study has done: an SQLite database with a rollback journal, every commit synced to the
/// disk. It survives the death of its process at any moment; being one plain file it can be copied, and it works where
/// write-ahead logs do not (network drives of a cluster). One process writes at a time, see DirectoryLock.
class StudyStore {
 public:
  /// Opens the database, or makes it where there is none.
  /// @throws InputError if it cannot be opened or made, is damaged, no database of ours, or of another schema version
  explicit StudyStore(const std::filesystem::path& path);

  std::optional<std::string> property(const std::string& name) const;
  /// In a transaction of its own. @throws InputError if it cannot be written
  void set_property(const std::string& name, const std::string& value);
  /// In a transaction of its own; a run stored before under the same key is replaced. @throws InputError likewise
  void add(const StoredRun& run);
  /// Forgets everything, in a transaction of its own.
  void clear();
  /// By key.
  std::vector<StoredRun> runs() const;

 private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };

  std::filesystem::path path_;
  std::unique_ptr<sqlite3, Closer> database_;
};

}  // namespace plumbline
