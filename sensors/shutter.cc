#include "sensors/shutter.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

int sub_frame_count(double motion_px) {
  return static_cast<int>(std::clamp(std::ceil(motion_px), 1.0, static_cast<double>(kMostSubFrames)));
}

double sub_frame_offset_s(const Shutter& shutter, int index, int count) {
  return ((index + 0.5) / count - 0.5) * shutter.span_s();
}

float row_share(const Shutter& shutter, int row, int index, int count) {
  if (shutter.row_delay_s == 0.0) return 1.0F / static_cast<float>(count);
  const double part_s = shutter.span_s() / count;
  const double opens_s = row * shutter.row_delay_s;  // since the span began
  const double begin_s = index * part_s;
  if (shutter.exposure_s == 0.0) {
    const int part_of_row = std::min(static_cast<int>(opens_s / part_s), count - 1);
    return part_of_row == index ? 1.0F : 0.0F;
  }
  const double overlap_s = std::min(opens_s + shutter.exposure_s, begin_s + part_s) - std::max(opens_s, begin_s);
  return static_cast<float>(std::max(overlap_s, 0.0) / shutter.exposure_s);
}

}  // namespace plumbline
