#pragma once

namespace plumbline {

/// When the rows of one frame see light. The frame's stamp is the middle of its middle row's exposure. A global shutter
/// opens all rows at once; a rolling one each row row_delay_s after the row above it.
struct Shutter {
  double exposure_s = 0.0;   ///< 0: an instant
  double row_delay_s = 0.0;  ///< 0: global
  int rows = 1;

  /// From the first light on the first row to the last on the last.
  double span_s() const { return exposure_s + row_delay_s * (rows - 1); }
};

/// How many pictures stand for the light of a frame during whose span the image moves by so many pixels: one a pixel,
/// at least one, at most kMostSubFrames.
int sub_frame_count(double motion_px);
inline constexpr int kMostSubFrames = 16;

/// The span is cut into equal parts, and each part's middle is drawn: seconds from the frame's stamp.
double sub_frame_offset_s(const Shutter& shutter, int index, int count);

/// The share of a row's exposure that falls into a part of the span. The shares of all parts add up to 1.
float row_share(const Shutter& shutter, int row, int index, int count);

}  // namespace plumbline
