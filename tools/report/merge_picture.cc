#include "tools/report/merge_picture.h"

#include <algorithm>
#include <opencv2/core.hpp>

#include "tools/formats/png.h"

namespace plumbline {
namespace {

constexpr int kPictureWidth_px = 1400;
constexpr int kMostHeight_px = 1400;
constexpr int kMargin_px = 20;
const cv::Vec3b kPaper(255, 255, 255);  // blue, green, red
const cv::Vec3b kOfA(200, 120, 40);
const cv::Vec3b kOfB(40, 140, 240);
const cv::Vec3b kOfBoth(90, 160, 60);

struct Extent {
  Eigen::Vector2f low = Eigen::Vector2f::Constant(1e30F);
  Eigen::Vector2f high = Eigen::Vector2f::Constant(-1e30F);
};

/// One view: x to the right, and y or z up.
class View {
 public:
  View(const std::vector<MapPoint>& a, const std::vector<MapPoint>& b, int up) : up_(up) {
    Extent extent;
    for (const auto* map : {&a, &b}) {
      for (const MapPoint& point : *map) {
        extent.low = extent.low.cwiseMin(flat(point));
        extent.high = extent.high.cwiseMax(flat(point));
      }
    }
    const Eigen::Vector2f size = (extent.high - extent.low).cwiseMax(1.0F);
    pixels_per_m_ = std::min(static_cast<float>(kPictureWidth_px - 2 * kMargin_px) / size.x(),
                             static_cast<float>(kMostHeight_px - 2 * kMargin_px) / size.y());
    low_ = extent.low;
    const int height = static_cast<int>(size.y() * pixels_per_m_) + 2 * kMargin_px + 1;
    image_ = cv::Mat(height, kPictureWidth_px, CV_8UC3, cv::Scalar(kPaper));
    for (const MapPoint& point : a) paint(point, kOfA, kOfA);
    for (const MapPoint& point : b) paint(point, kOfB, kOfBoth);
  }
  const cv::Mat& image() const { return image_; }

 private:
  Eigen::Vector2f flat(const MapPoint& point) const { return {point.position.x(), point.position[up_]}; }

  /// @param over_a  where the other map has painted
  void paint(const MapPoint& point, const cv::Vec3b& alone, const cv::Vec3b& over_a) {
    const Eigen::Vector2f at = (flat(point) - low_) * pixels_per_m_;
    const int column = std::clamp(kMargin_px + static_cast<int>(at.x()), 0, image_.cols - 1);
    const int row = std::clamp(image_.rows - 1 - kMargin_px - static_cast<int>(at.y()), 0, image_.rows - 1);
    auto& pixel = image_.at<cv::Vec3b>(row, column);
    pixel = pixel == kOfA || pixel == kOfBoth ? over_a : alone;
  }

  int up_;
  float pixels_per_m_ = 1.0F;
  Eigen::Vector2f low_ = Eigen::Vector2f::Zero();
  cv::Mat image_;
};

}  // namespace

std::vector<std::uint8_t> merge_picture(const std::vector<MapPoint>& a, const std::vector<MapPoint>& b) {
  cv::Mat both;
  cv::vconcat(View(a, b, /*up=*/1).image(), View(a, b, /*up=*/2).image(), both);
  return encode_png(both, 4);
}

}  // namespace plumbline
