#include "tools/formats/tum.h"

#include <stdexcept>

#include "scenarios/scenario.h"
#include "sim/tum_file.h"
#include "tools/formats/number_text.h"

namespace plumbline {

std::vector<PoseTrack::Stamped> read_tum(const std::filesystem::path& path) {
  try {
    return read_tum_file(path);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
}

std::string tum_text(const std::vector<PoseTrack::Stamped>& poses) {
  std::string text = "# timestamp_s tx ty tz qx qy qz qw\n";
  text.reserve(text.size() + poses.size() * 120);
  for (const auto& [stamp_ns, pose] : poses) {
    append_seconds(text, stamp_ns);
    for (const double value : {pose.translation.x(), pose.translation.y(), pose.translation.z()}) {
      append_fixed(text += ' ', value, 9);
    }
    for (const double value : {pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.rotation.w()}) {
      append_fixed(text += ' ', value, 12);
    }
    text += '\n';
  }
  return text;
}

}  // namespace plumbline
