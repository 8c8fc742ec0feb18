#include "estimator/vision/feature_source.h"

#include <algorithm>

namespace plumbline {

FeatureSource::FeatureSource(const CameraIntrinsics& camera, const CameraNoise& noise)
    : camera_(camera), noise_(noise) {}

bool FeatureSource::take(const CameraFrame& frame) {
  const bool usable =
      frame.width == camera_.width && frame.height == camera_.height && frame.width > 0 && frame.height > 0 &&
      frame.pixels.size() == static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  if (!usable) return false;
  given_ = false;
  tracker_.set_image(view_of(frame));
  return true;
}

bool FeatureSource::take(const PointFrame& frame) {
  std::vector<PointFrame::Point> points = sorted_points(frame);
  if (points.empty() && !frame.points.empty()) return false;
  given_ = true;
  points_ = std::move(points);
  return true;
}

std::vector<FeatureTracker::Track> FeatureSource::locate(const std::vector<Sought>& sought) {
  if (given_) return locate_given(sought);
  std::vector<FeatureTracker::Sought> patches;
  patches.reserve(sought.size());
  for (const Sought& s : sought) patches.push_back(s.patch);
  return tracker_.track(patches);
}

std::vector<FeatureTracker::Track> FeatureSource::locate_given(const std::vector<Sought>& sought) const {
  std::vector<FeatureTracker::Track> tracks(sought.size());
  for (std::size_t i = 0; i < sought.size(); ++i) {
    const PointFrame::Point* seen = find_point(points_, sought[i].id);
    if (seen != nullptr) tracks[i] = {seen->pixel, 0.0F, true};
  }
  return tracks;
}

std::vector<FeatureSource::Fresh> FeatureSource::find_new(const std::vector<Seen>& present,
                                                          const CornerOptions& options) {
  std::vector<Fresh> fresh;
  if (given_) {
    std::vector<std::int64_t> known;
    for (const Seen& s : present) known.push_back(s.id);
    std::sort(known.begin(), known.end());
    for (const PointFrame::Point& p : points_) {
      if (!std::binary_search(known.begin(), known.end(), p.id)) fresh.push_back({p.id, p.pixel, 0.0});
    }
    return fresh;
  }
  std::vector<Eigen::Vector2f> occupied;
  occupied.reserve(present.size());
  for (const Seen& s : present) occupied.push_back(s.pixel);
  const GreyView newest = image();
  for (const Corner& corner : find_corners(newest, image_noise_dn(newest, noise_), occupied, options)) {
    fresh.push_back({next_id_++, corner.pixel, corner.noise_sigma_px});
  }
  return fresh;
}

void FeatureSource::anchor_here() {
  if (!given_) tracker_.anchor_here();
}

GreyView FeatureSource::image() const { return given_ ? GreyView{} : tracker_.image(); }

}  // namespace plumbline
