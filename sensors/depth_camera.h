#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/messages.h"
#include "sim/renderer.h"

namespace plumbline {

/// A camera that triangulates the pattern of an infrared projector beside it: depth is focal length times baseline over
/// disparity, so that a constant error of disparity makes an error of depth that grows with its square.
struct DepthCameraModel {
  std::string name = "xtion";
  int width = 640;
  int height = 480;
  double horizontal_fov_deg = 58.0;
  double rate_hz = 30.0;
  double baseline_m = 0.075;          ///< projector right of the camera
  double disparity_step_px = 0.125;   ///< quantisation
  double disparity_sigma_px = 0.055;  ///< white, per pixel
  double min_range_m = 0.5;
  double max_range_m = 5.0;
  int edge_px = 2;  ///< half the window that is matched: around a jump of depth there is no match
};

struct DepthCameraEffects {
  bool noise = true;
  bool quantisation = true;
  bool edges = true;   ///< no depth around jumps of depth
  bool shadow = true;  ///< none where the projector does not reach
};

/// @throws std::invalid_argument naming the field that is out of range.
void validate_or_throw(const DepthCameraModel& model);
CameraIntrinsics intrinsics_of(const DepthCameraModel& model);

class DepthCamera {
 public:
  /// @param seed  the scenario's; @param name of this camera on its rig
  DepthCamera(DepthCameraModel model, const DepthCameraEffects& effects, std::uint64_t seed, std::string_view name);

  const RenderView& view() const { return view_; }

  /// Depth as the device reports it, 0 where it has none. Deterministic in (seed, name, frame_index).
  /// @throws std::invalid_argument if the picture has no depth of the view's size
  DepthFrame measure(const RadianceImage& picture, std::int64_t stamp_ns, int camera_id,
                     std::int64_t frame_index) const;

 private:
  std::vector<float> disparities(const RadianceImage& picture) const;
  bool at_edge(const std::vector<float>& disparity, int column, int row) const;
  void measure_row(const std::vector<float>& disparity, int row, std::uint64_t frame_seed,
                   std::vector<float>& depth_m) const;

  DepthCameraModel model_;
  DepthCameraEffects effects_;
  std::uint64_t seed_ = 0;
  RenderView view_;
  float focal_length_times_baseline_ = 0.0F;  ///< [px m]
};

}  // namespace plumbline
