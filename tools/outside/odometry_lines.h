#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "estimator/estimator.h"

/// What an outside estimator answers, as lines of text: a word and its fields, separated by blanks. README.md beside
/// this file describes them for those who write one.
namespace plumbline {

constexpr int kOdometryLinesVersion = 1;

/// The first line of all answers.
/// @param acknowledge  whether messages other than IMU samples are answered too, by kDone
std::string greeting_line(bool acknowledge);
/// @returns nothing unless it is such a line of this version; otherwise whether messages are acknowledged
std::optional<bool> read_greeting(const std::string& line);

constexpr const char* kNoPose = "none";  ///< no pose for this sample
constexpr const char* kDone = "done";

/// The lines of one output, its pose last, each with its end.
std::string odometry_lines(const Odometry& odometry);

/// The lines that say what became of a module's messages, and of the map's points.
std::string counts_lines(Module module, const MessageCounts& counts);
std::string point_line(const MapPoint& point);

/// Puts an output together from its lines.
class OdometryLines {
 public:
  /// @returns whether the line was the pose, which completes it
  /// @throws std::invalid_argument for a line that is none of these, or with fields that are missing, too many, not
  /// finite or impossible
  bool add(const std::string& line);
  /// The output; the next one is begun.
  Odometry take();

 private:
  Odometry odometry_;
};

/// Puts together what follows the last output.
struct ClosingLines {
  std::map<Module, MessageCounts> counts;  ///< of modules that were spoken of
  std::vector<MapPoint> map;

  /// @throws std::invalid_argument as above
  void add(const std::string& line);
};

}  // namespace plumbline
