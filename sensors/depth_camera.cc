#include "sensors/depth_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sensors/lens.h"
#include "sensors/photon_noise.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

// Surfaces at less than a pixel of disparity from each other match as one.
constexpr float kJump_px = 1.0F;

}  // namespace

void validate_or_throw(const DepthCameraModel& model) {
  const auto require = [&model](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument("depth camera " + model.name + ": " + rule);
  };
  require(model.width > 0 && model.height > 0, "width and height must be positive");
  require(model.horizontal_fov_deg > 0.0 && model.horizontal_fov_deg < 180.0,
          "horizontal_fov_deg must be within (0, 180)");
  require(model.rate_hz > 0.0, "rate_hz must be positive");
  require(model.baseline_m > 0.0, "baseline_m must be positive");
  require(model.disparity_step_px > 0.0, "disparity_step_px must be positive");
  require(model.disparity_sigma_px >= 0.0, "disparity_sigma_px must not be negative");
  require(model.min_range_m > 0.0 && model.max_range_m > model.min_range_m, "0 < min_range_m < max_range_m must hold");
  require(model.edge_px >= 0, "edge_px must not be negative");
}

CameraIntrinsics intrinsics_of(const DepthCameraModel& model) {
  const double half_fov = 0.5 * model.horizontal_fov_deg * std::numbers::pi / 180.0;
  const double focal_length = 0.5 * model.width / std::tan(half_fov);
  return {model.width, model.height, focal_length, focal_length, 0.5 * (model.width - 1), 0.5 * (model.height - 1), {}};
}

DepthCamera::DepthCamera(DepthCameraModel model, const DepthCameraEffects& effects, std::uint64_t seed,
                         std::string_view name)
    : model_((validate_or_throw(model), std::move(model))),
      effects_(effects),
      seed_(derive_seed(seed, name)),
      view_(pinhole_view(intrinsics_of(model_))),
      focal_length_times_baseline_(static_cast<float>(view_.fx * model_.baseline_m)) {}

DepthFrame DepthCamera::measure(const RadianceImage& picture, std::int64_t stamp_ns, int camera_id,
                                std::int64_t frame_index) const {
  const auto pixels = static_cast<std::size_t>(view_.width) * static_cast<std::size_t>(view_.height);
  if (picture.width != view_.width || picture.height != view_.height || picture.depth_m.size() != pixels) {
    throw std::invalid_argument("depth camera " + model_.name + ": the picture has no depth of its size");
  }
  DepthFrame frame{stamp_ns, camera_id, view_.width, view_.height, std::vector<float>(pixels, 0.0F)};
  const std::vector<float> disparity = disparities(picture);
  const std::uint64_t frame_seed = mix_bits(seed_ ^ mix_bits(static_cast<std::uint64_t>(frame_index)));
  for (int row = 0; row < view_.height; ++row) measure_row(disparity, row, frame_seed, frame.depth_m);
  return frame;
}

std::vector<float> DepthCamera::disparities(const RadianceImage& picture) const {
  std::vector<float> disparity(picture.depth_m.size());
  std::transform(picture.depth_m.begin(), picture.depth_m.end(), disparity.begin(),
                 [this](float depth) { return focal_length_times_baseline_ / depth; });
  return disparity;
}

bool DepthCamera::at_edge(const std::vector<float>& disparity, int column, int row) const {
  const auto at = [&](int u, int v) {
    const int inside_u = std::clamp(u, 0, view_.width - 1);
    const int inside_v = std::clamp(v, 0, view_.height - 1);
    return disparity[static_cast<std::size_t>(inside_v * view_.width + inside_u)];
  };
  const float here = at(column, row);
  const int reach = model_.edge_px;
  return std::abs(at(column - reach, row) - here) > kJump_px || std::abs(at(column + reach, row) - here) > kJump_px ||
         std::abs(at(column, row - reach) - here) > kJump_px || std::abs(at(column, row + reach) - here) > kJump_px;
}

/// From right to left: the projector sees a pixel at its column less its disparity, and of what it would see farther
/// left than something already met, that something is in the way.
void DepthCamera::measure_row(const std::vector<float>& disparity, int row, std::uint64_t frame_seed,
                              std::vector<float>& depth_m) const {
  const auto step = static_cast<float>(model_.disparity_step_px);
  const auto sigma = effects_.noise ? static_cast<float>(model_.disparity_sigma_px) : 0.0F;
  const float most = focal_length_times_baseline_ / static_cast<float>(model_.min_range_m);
  const float least = focal_length_times_baseline_ / static_cast<float>(model_.max_range_m);
  const NoiseTables& draws = noise_tables();
  float leftmost_lit = std::numeric_limits<float>::infinity();
  for (int column = view_.width - 1; column >= 0; --column) {
    const auto i = static_cast<std::size_t>(row * view_.width + column);
    const float projector_column = static_cast<float>(column) - disparity[i];
    const bool in_shadow = effects_.shadow && projector_column > leftmost_lit;
    leftmost_lit = std::min(leftmost_lit, projector_column);
    if (in_shadow || (effects_.edges && at_edge(disparity, column, row))) continue;
    float measured = disparity[i] + sigma * draws.gaussian(mix_bits(frame_seed + i));
    if (effects_.quantisation) measured = step * std::round(measured / step);
    if (measured >= least && measured <= most) depth_m[i] = focal_length_times_baseline_ / measured;
  }
}

}  // namespace plumbline
