#include "estimator/vision/feature_tracker.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/video/tracking.hpp>

#include "estimator/vision/image_patch.h"

namespace plumbline {
namespace {

constexpr int kWindow = 15;      // [px]
constexpr int kTopLevel = 2;     // three levels: a prediction may err by some 25 px
constexpr int kGainRadius = 4;   // [px] of the boxes whose brightness is compared before tracking
constexpr float kBorder = 8.0F;  // [px]: half the window
constexpr double kMaxGain = 4.0;
/// Least normalised correlation of a patch with its anchor. With image noise of variance n over texture of variance s
/// a true match scores about s / (s + n); a patch buried in noise scores near 0, whatever the search made of it.
constexpr double kLeastCorrelation = 0.7;

double box_mean(const cv::Mat& image, int x, int y) {
  int sum = 0;
  for (int v = y - kGainRadius; v <= y + kGainRadius; ++v) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(v);
    for (int u = x - kGainRadius; u <= x + kGainRadius; ++u) sum += row[u];
  }
  return static_cast<double>(sum) / ((2 * kGainRadius + 1) * (2 * kGainRadius + 1));
}

GreyView view_of(const cv::Mat& image) { return {image.data, image.cols, image.rows, static_cast<int>(image.step)}; }

}  // namespace

struct FeatureTracker::Impl {
  cv::Mat newest;         // as it came
  cv::Mat newest_scaled;  // brought to the anchor's exposure
  cv::Mat anchor;
  std::vector<cv::Mat> anchor_pyramid;  // with derivatives, kept as long as the anchor
  std::vector<cv::Mat> newest_pyramid;
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> to;
  std::vector<std::uint8_t> status;
  std::vector<double> ratios;

  double exposure_ratio();
  bool looks_like_its_anchor(const Eigen::Vector2f& anchor_pixel, const Eigen::Vector2f& pixel) const;
};

FeatureTracker::FeatureTracker() : impl_(std::make_unique<Impl>()) {}
FeatureTracker::FeatureTracker(FeatureTracker&&) noexcept = default;
FeatureTracker& FeatureTracker::operator=(FeatureTracker&&) noexcept = default;
FeatureTracker::~FeatureTracker() = default;

void FeatureTracker::set_image(const GreyView& image) {
  const cv::Mat borrowed(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                         static_cast<std::size_t>(image.stride));
  borrowed.copyTo(impl_->newest);
}

GreyView FeatureTracker::image() const { return view_of(impl_->newest); }

void FeatureTracker::anchor_here() {
  impl_->newest.copyTo(impl_->anchor);
  cv::buildOpticalFlowPyramid(impl_->anchor, impl_->anchor_pyramid, cv::Size(kWindow, kWindow), kTopLevel, true);
}

/// Anchor's over newest image's exposure, from the brightness where the features are expected. The tracker assumes
/// constant brightness, so uncompensated auto exposure would pull every corner towards its brighter or darker side.
double FeatureTracker::Impl::exposure_ratio() {
  ratios.clear();
  constexpr float kReach = kGainRadius + 1.0F;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (!inside(view_of(anchor), {from[i].x, from[i].y}, kReach)) continue;
    if (!inside(view_of(newest), {to[i].x, to[i].y}, kReach)) continue;
    const double now = box_mean(newest, static_cast<int>(to[i].x), static_cast<int>(to[i].y));
    const double then = box_mean(anchor, static_cast<int>(from[i].x), static_cast<int>(from[i].y));
    if (now > 1.0) ratios.push_back(then / now);
  }
  if (ratios.empty()) return 1.0;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return std::clamp(*middle, 1.0 / kMaxGain, kMaxGain);
}

bool FeatureTracker::Impl::looks_like_its_anchor(const Eigen::Vector2f& anchor_pixel,
                                                 const Eigen::Vector2f& pixel) const {
  const GreyView then = view_of(anchor);
  const GreyView now = view_of(newest);
  return inside(now, pixel, kBorder) && inside(then, anchor_pixel, kBorder) &&
         correlation(read_patch(then, anchor_pixel), read_patch(now, pixel)) > kLeastCorrelation;
}

FeatureTracker::Tracks FeatureTracker::track(const std::vector<Eigen::Vector2f>& anchor_pixels,
                                             const std::vector<Eigen::Vector2f>& predicted) {
  Impl& m = *impl_;
  Tracks tracks;
  if (anchor_pixels.empty() || m.anchor_pyramid.empty()) return tracks;
  m.from.clear();
  m.to.clear();
  for (const auto& p : anchor_pixels) m.from.emplace_back(p.x(), p.y());
  for (const auto& p : predicted) m.to.emplace_back(p.x(), p.y());

  m.newest.convertTo(m.newest_scaled, CV_8U, m.exposure_ratio());
  const cv::Size window(kWindow, kWindow);
  cv::buildOpticalFlowPyramid(m.newest_scaled, m.newest_pyramid, window, kTopLevel, false);
  const cv::TermCriteria stop(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.02);
  cv::calcOpticalFlowPyrLK(m.anchor_pyramid, m.newest_pyramid, m.from, m.to, m.status, cv::noArray(), window, kTopLevel,
                           stop, cv::OPTFLOW_USE_INITIAL_FLOW);
  tracks.pixels.reserve(m.to.size());
  tracks.found.reserve(m.to.size());
  for (std::size_t i = 0; i < m.to.size(); ++i) {
    tracks.pixels.emplace_back(m.to[i].x, m.to[i].y);
    const bool found = m.status[i] != 0 && m.looks_like_its_anchor(anchor_pixels[i], tracks.pixels.back());
    tracks.found.push_back(found ? 1 : 0);
  }
  return tracks;
}

}  // namespace plumbline
