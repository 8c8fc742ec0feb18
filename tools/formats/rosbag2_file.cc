#include "tools/formats/rosbag2_file.h"

#include <sqlite3.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "scenarios/config_reader.h"
#include "scenarios/input_error.h"
#include "scenarios/yaml_reader.h"
#include "tools/formats/output_file.h"
#include "tools/formats/ros_cdr.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBagFiles = 10'000;
constexpr const char* kDatabase = "data_0.db3";
constexpr const char* kMetadata = "metadata.yaml";

// As Humble's rosbag2_storage_default_plugins writes it.
constexpr const char* kSchema = R"sql(
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
                    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
                      data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
INSERT INTO schema VALUES (3, 'humble');
)sql";

struct Close {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// A database and what it says when something fails.
class Database {
 public:
  Database(const fs::path& path, int flags) : path_(path) {
    sqlite3* opened = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &opened, flags, nullptr);
    database_.reset(opened);
    if (code != SQLITE_OK) fail();
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostRosBytes));
  }

  [[noreturn]] void fail() const {
    throw InputError(path_.string() + ": cannot be used as a ROS 2 bag: " +
                     (database_ ? sqlite3_errmsg(database_.get()) : "out of memory"));
  }
  void execute(const char* sql) const {
    if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }
  std::unique_ptr<sqlite3_stmt, Close> prepare(const char* sql) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) fail();
    return std::unique_ptr<sqlite3_stmt, Close>(statement);
  }
  bool step(sqlite3_stmt* statement) const {
    const int code = sqlite3_step(statement);
    if (code != SQLITE_ROW && code != SQLITE_DONE) fail();
    return code == SQLITE_ROW;
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  std::unique_ptr<sqlite3, Close> database_;
};

std::string_view blob_of(sqlite3_stmt* statement, int column) {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, column));
  return bytes == nullptr ? std::string_view()
                          : std::string_view(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement, column)));
}

/// One file of a bag.
class DatabaseReader {
 public:
  DatabaseReader(const fs::path& path, const std::set<std::string>& topics) : database_(path, SQLITE_OPEN_READONLY) {
    const auto rows = database_.prepare("SELECT id, name, type FROM topics");
    while (database_.step(rows.get())) {
      const std::string name(blob_of(rows.get(), 1));
      if (topics.count(name) != 0) {
        topics_[sqlite3_column_int64(rows.get(), 0)] = {name, std::string(blob_of(rows.get(), 2))};
      }
    }
    messages_ = database_.prepare("SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp, id");
  }

  std::optional<RosMessage> next() {
    while (database_.step(messages_.get())) {
      ++row_;
      const auto topic = topics_.find(sqlite3_column_int64(messages_.get(), 0));
      if (topic == topics_.end()) continue;
      auto payload = decoded(topic->second.type, blob_of(messages_.get(), 2));
      if (payload) return RosMessage{topic->second.name, sqlite3_column_int64(messages_.get(), 1), std::move(*payload)};
    }
    return std::nullopt;
  }

 private:
  struct Topic {
    std::string name;
    std::string type;
  };

  std::optional<RosPayload> decoded(const std::string& type, std::string_view bytes) const {
    try {
      return from_cdr(type, bytes);
    } catch (const std::invalid_argument& error) {
      throw InputError(database_.path().string() + ": message " + std::to_string(row_) + ": " + error.what());
    }
  }

  Database database_;
  std::map<std::int64_t, Topic> topics_;
  std::unique_ptr<sqlite3_stmt, Close> messages_;
  std::int64_t row_ = 0;
};

/// The databases that metadata.yaml names, in its order.
std::vector<fs::path> files_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return {path};
  const ConfigNode metadata = read_yaml_file(path / kMetadata);
  ConfigReader file(metadata, "");
  const ConfigNode* information = file.find("rosbag2_bagfile_information");
  if (information == nullptr) throw InputError(metadata.where + ": no rosbag2_bagfile_information");
  ConfigReader reader(*information, "rosbag2_bagfile_information");
  const ConfigNode* names = reader.find("relative_file_paths");
  if (names == nullptr) throw InputError(information->where + ": no relative_file_paths");
  const ConfigNode* compressed = reader.find("compression_format");
  if (compressed != nullptr && !compressed->text.empty()) {
    throw InputError(compressed->where + ": the bag is compressed (" + compressed->text + "), which is not read");
  }
  std::vector<fs::path> files;
  for (const ConfigNode& name : list_of(*names, "relative_file_paths")) {
    if (files.size() == kMostBagFiles) throw InputError(names->where + ": more than 10,000 files");
    files.push_back(listed_file(path, text_of(name, "relative_file_paths")));
  }
  return files;
}

class BagReader {
 public:
  BagReader(const fs::path& path, std::set<std::string> topics) : files_(files_of(path)), topics_(std::move(topics)) {}

  std::optional<RosMessage> next() {
    while (true) {
      if (!database_ && next_file_ == files_.size()) return std::nullopt;
      if (!database_) database_ = std::make_unique<DatabaseReader>(files_[next_file_++], topics_);
      if (auto message = database_->next()) return message;
      database_.reset();
    }
  }

 private:
  std::vector<fs::path> files_;
  std::set<std::string> topics_;
  std::size_t next_file_ = 0;
  std::unique_ptr<DatabaseReader> database_;
};

class Rosbag2Writer final : public RosSink {
 public:
  explicit Rosbag2Writer(const fs::path& directory)
      : directory_(directory), database_(directory / kDatabase, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE) {
    database_.execute("PRAGMA synchronous = OFF");  // the folder appears by rename, when all is written
    database_.execute(kSchema);
    database_.execute("BEGIN");
    insert_ = database_.prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)");
  }

  void write(const RosMessage& message) override {
    Topic& topic = topic_of(message);
    ++topic.count;
    const std::string bytes = to_cdr(message.payload);
    sqlite3_bind_int64(insert_.get(), 1, topic.id);
    sqlite3_bind_int64(insert_.get(), 2, message.time_ns);
    sqlite3_bind_blob64(insert_.get(), 3, bytes.data(), bytes.size(), SQLITE_STATIC);
    database_.step(insert_.get());
    sqlite3_reset(insert_.get());
    sqlite3_clear_bindings(insert_.get());
    if (count_ == 0) first_ns_ = last_ns_ = message.time_ns;
    first_ns_ = std::min(first_ns_, message.time_ns);
    last_ns_ = std::max(last_ns_, message.time_ns);
    ++count_;
  }

  void close() override {
    insert_.reset();
    database_.execute("COMMIT");
    write_whole_file(directory_ / kMetadata, metadata());
  }

 private:
  struct Topic {
    std::int64_t id = 0;
    std::string type;
    std::int64_t count = 0;
  };

  Topic& topic_of(const RosMessage& message) {
    const auto [topic, is_new] = topics_.try_emplace(message.topic);
    if (!is_new) return topic->second;
    topic->second = {static_cast<std::int64_t>(topics_.size()), ros2_type(message.payload), 0};
    const auto row = database_.prepare("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')");
    sqlite3_bind_int64(row.get(), 1, topic->second.id);
    sqlite3_bind_text(row.get(), 2, message.topic.c_str(), -1, SQLITE_TRANSIENT);
    sqlite3_bind_text(row.get(), 3, topic->second.type.c_str(), -1, SQLITE_TRANSIENT);
    database_.step(row.get());
    return topic->second;
  }

  std::string metadata() const {
    const std::string duration = std::to_string(last_ns_ - first_ns_);
    const std::string start = std::to_string(first_ns_);
    std::string text =
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  duration:\n"
        "    nanoseconds: " +
        duration + "\n  starting_time:\n    nanoseconds_since_epoch: " + start +
        "\n  message_count: " + std::to_string(count_) + "\n  topics_with_message_count:\n";
    for (const auto& [name, topic] : topics_) {
      text += "    - topic_metadata:\n        name: " + name + "\n        type: " + topic.type +
              "\n        serialization_format: cdr\n        offered_qos_profiles: \"\"\n      message_count: " +
              std::to_string(topic.count) + "\n";
    }
    return text + "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - " + kDatabase +
           "\n  files:\n    - path: " + kDatabase +
           "\n      starting_time:\n        nanoseconds_since_epoch: " + start +
           "\n      duration:\n        nanoseconds: " + duration + "\n      message_count: " + std::to_string(count_) +
           "\n";
  }

  fs::path directory_;
  Database database_;
  std::unique_ptr<sqlite3_stmt, Close> insert_;
  std::map<std::string, Topic> topics_;
  std::int64_t count_ = 0;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace

RosSource open_rosbag2_file(const fs::path& path, const std::set<std::string>& topics) {
  return [reader = std::make_shared<BagReader>(path, topics)] { return reader->next(); };
}

std::unique_ptr<RosSink> make_rosbag2_file(const fs::path& directory) {
  return std::make_unique<Rosbag2Writer>(directory);
}

}  // namespace plumbline
