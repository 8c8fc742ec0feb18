#include "tools/formats/truth_file.h"

#include <cmath>

#include "tools/formats/text_table.h"
#include "tools/formats/tum.h"

namespace plumbline {
namespace {

std::vector<PoseTrack::Stamped> read_euroc_truth(const std::filesystem::path& path) {
  std::vector<PoseTrack::Stamped> truth;
  TextTable table(path, ", \t\r");
  while (table.next()) {
    PoseTrack::Stamped stamped;
    stamped.stamp_ns = table.whole(0);
    stamped.pose.translation = {table.number(1), table.number(2), table.number(3)};
    const Eigen::Quaterniond rotation(table.number(4), table.number(5), table.number(6), table.number(7));
    if (!(std::abs(rotation.norm() - 1.0) < kQuaternionTolerance)) table.reject("the quaternion is not of unit length");
    stamped.pose.rotation = rotation.normalized();
    if (!truth.empty() && stamped.stamp_ns <= truth.back().stamp_ns) table.reject("stamps must increase");
    truth.push_back(stamped);
  }
  return truth;
}

}  // namespace

std::vector<PoseTrack::Stamped> read_truth_file(const std::filesystem::path& path) {
  return path.extension() == ".csv" ? read_euroc_truth(path) : read_tum(path);
}

}  // namespace plumbline
