#include "estimator/vision/feature_tracker.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/video/tracking.hpp>

#include "estimator/vision/image_patch.h"
#include "estimator/vision/patch_alignment.h"

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
constexpr float kUnalignedSigma_px = 0.25F;  // of tracks whose patches could only be shifted

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
  Track refined(const Sought& sought, const Eigen::Vector2f& pixel) const;
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

/// The pyramid's search shifts patches and so comes near; the place is where the deformed patch fits.
FeatureTracker::Track FeatureTracker::Impl::refined(const Sought& sought, const Eigen::Vector2f& pixel) const {
  if (!looks_like_its_anchor(sought.anchor_pixel, pixel)) return {};
  const auto aligned =
      align_patch(view_of(anchor), sought.anchor_pixel, view_of(newest), sought.now_from_anchor, pixel);
  return aligned ? Track{aligned->pixel, aligned->sigma_px, true} : Track{pixel, kUnalignedSigma_px, true};
}

std::vector<FeatureTracker::Track> FeatureTracker::track(const std::vector<Sought>& sought) {
  Impl& m = *impl_;
  if (sought.empty() || m.anchor_pyramid.empty()) return {};
  m.from.clear();
  m.to.clear();
  for (const Sought& s : sought) {
    m.from.emplace_back(s.anchor_pixel.x(), s.anchor_pixel.y());
    m.to.emplace_back(s.predicted.x(), s.predicted.y());
  }

  m.newest.convertTo(m.newest_scaled, CV_8U, m.exposure_ratio());
  const cv::Size window(kWindow, kWindow);
  cv::buildOpticalFlowPyramid(m.newest_scaled, m.newest_pyramid, window, kTopLevel, false);
  const cv::TermCriteria stop(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 10, 0.1);
  cv::calcOpticalFlowPyrLK(m.anchor_pyramid, m.newest_pyramid, m.from, m.to, m.status, cv::noArray(), window, kTopLevel,
                           stop, cv::OPTFLOW_USE_INITIAL_FLOW);
  std::vector<Track> tracks(sought.size());
  for (std::size_t i = 0; i < sought.size(); ++i) {
    if (m.status[i] != 0) tracks[i] = m.refined(sought[i], {m.to[i].x, m.to[i].y});
  }
  return tracks;
}

}  // namespace plumbline
