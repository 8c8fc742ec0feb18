#include "estimator/vision/corner_detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

namespace plumbline {
namespace {

/// Corners are sought at half resolution: a quarter of the work, and 7 pixels there are the tracker's window here.
constexpr int kShrink = 2;
constexpr int kBlock = 7;         // [half-resolution px] over which the structure tensor is summed
constexpr int kTrackWindow = 15;  // [px] of the tracker: its noise falls with the gradient energy in there
/// Least smaller eigenvalue over the variance of the full image's noise. Noise alone reaches 3 to 6 at the best place
/// of an image, and 14 where clipping at black upsets the noise estimate (measured over 300 images).
constexpr double kLeastEigenvalueOverNoise = 40.0;

/// What cv::cornerMinEigenVal's response must be multiplied by to be the tensor's eigenvalue in DN^2: it scales Sobel
/// (8 times the derivative) by 1 / (4 * block * 255) before squaring.
constexpr double kEigenvaluePerResponse = (0.5 * kBlock * 255.0) * (0.5 * kBlock * 255.0);

/// Marks a disc-like square around every feature, so that a corner's distance to all others costs one look.
class Occupancy {
 public:
  Occupancy(int width, int height, int distance) : width_(width), height_(height), distance_(distance) {
    taken_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  }
  bool taken(int x, int y) const { return taken_[index(x, y)] != 0; }
  void take(int x, int y) {
    for (int v = std::max(0, y - distance_); v <= std::min(height_ - 1, y + distance_); ++v) {
      const int first = std::max(0, x - distance_);
      const int last = std::min(width_ - 1, x + distance_);
      if (first > last) continue;
      std::fill(taken_.begin() + static_cast<std::ptrdiff_t>(index(first, v)),
                taken_.begin() + static_cast<std::ptrdiff_t>(index(last, v)) + 1, std::uint8_t{1});
    }
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_;
  int height_;
  int distance_;
  std::vector<std::uint8_t> taken_;
};

struct Candidate {
  float response = 0.0F;
  int x = 0;
  int y = 0;
};

bool is_local_maximum(const cv::Mat& response, int x, int y) {
  const float value = response.at<float>(y, x);
  for (int v = y - 1; v <= y + 1; ++v) {
    const float* row = response.ptr<float>(v);
    if (row[x - 1] > value || row[x] > value || row[x + 1] > value) return false;
  }
  return true;
}

/// Local maxima above the threshold in full-resolution pixels, strongest first; position breaks ties, so the order
/// never depends on the sort.
std::vector<Candidate> candidates_in(const cv::Mat& response, const cv::Rect& cell, float threshold) {
  std::vector<Candidate> candidates;
  for (int y = 1; y + 1 < response.rows; ++y) {
    const float* row = response.ptr<float>(y);
    for (int x = 1; x + 1 < response.cols; ++x) {
      if (row[x] > threshold && is_local_maximum(response, x, y)) {
        candidates.push_back({row[x], kShrink * (x + cell.x), kShrink * (y + cell.y)});
      }
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.response != b.response) return a.response > b.response;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  return candidates;
}

/// One sigma of a least-squares translation over the tracking window, noise in both images.
double noise_sigma_px(float response, double noise_dn) {
  constexpr double kWindowShare =
      static_cast<double>(kTrackWindow * kTrackWindow) / (kBlock * kBlock * kShrink * kShrink);
  const double window_eigenvalue = response * kEigenvaluePerResponse * kWindowShare;
  return noise_dn * std::sqrt(2.0 / window_eigenvalue);
}

}  // namespace

int features_of_share(int features_per_cell, double share) {
  return std::max(1, static_cast<int>(std::lround(share * features_per_cell)));
}

double image_noise_dn(const GreyView& image, const CameraNoise& data_sheet) {
  // Immerkaer's mask [1 -2 1; -2 4 -2; 1 -2 1] is blind to any ramp and to any edge along an axis; noise passes with
  // gain 6. Every third pixel of every third row is plenty for a median.
  std::array<int, 16 * 255 + 1> histogram{};
  int samples = 0;
  double sum = 0.0;
  for (int y = 1; y + 1 < image.height; y += 3) {
    const std::uint8_t* a = image.data + static_cast<std::ptrdiff_t>(y - 1) * image.stride;
    const std::uint8_t* b = a + image.stride;
    const std::uint8_t* c = b + image.stride;
    for (int x = 1; x + 1 < image.width; x += 3) {
      const int response =
          a[x - 1] - 2 * a[x] + a[x + 1] - 2 * b[x - 1] + 4 * b[x] - 2 * b[x + 1] + c[x - 1] - 2 * c[x] + c[x + 1];
      ++histogram[static_cast<std::size_t>(std::abs(response))];
      ++samples;
      sum += b[x];
    }
  }
  if (samples == 0) return data_sheet.read_noise_dn;
  std::size_t median = 0;
  for (int seen = histogram[0]; 2 * seen < samples; seen += histogram[median]) ++median;
  const double measured = static_cast<double>(median) / (0.6745 * 6.0);
  const double mean_dn = sum / samples;
  const double promised = std::sqrt(data_sheet.read_noise_dn * data_sheet.read_noise_dn +
                                    mean_dn / data_sheet.electrons_per_dn + 1.0 / 12.0);
  return std::max(measured, promised);
}

std::vector<Corner> find_corners(const GreyView& image, double noise_dn, const std::vector<Eigen::Vector2f>& occupied,
                                 const CornerOptions& options) {
  const cv::Mat grey(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                     static_cast<std::size_t>(image.stride));
  Occupancy occupancy(image.width, image.height, options.min_distance_px);
  std::vector<int> held(static_cast<std::size_t>(options.grid_rows) * static_cast<std::size_t>(options.grid_cols), 0);
  const auto cell_of = [&](float x, float y) {
    const int column = std::clamp(static_cast<int>(x) * options.grid_cols / image.width, 0, options.grid_cols - 1);
    const int row = std::clamp(static_cast<int>(y) * options.grid_rows / image.height, 0, options.grid_rows - 1);
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(options.grid_cols) +
           static_cast<std::size_t>(column);
  };
  for (const Eigen::Vector2f& p : occupied) {
    occupancy.take(static_cast<int>(p.x()), static_cast<int>(p.y()));
    ++held[cell_of(p.x(), p.y())];
  }

  const auto threshold = static_cast<float>(kLeastEigenvalueOverNoise * noise_dn * noise_dn / kEigenvaluePerResponse);
  cv::Mat half;
  cv::pyrDown(grey, half);
  const int border = options.border_px / kShrink;
  const cv::Rect usable(border, border, half.cols - 2 * border, half.rows - 2 * border);
  std::vector<Corner> corners;
  cv::Mat response;
  for (int row = 0; row < options.grid_rows; ++row) {
    for (int column = 0; column < options.grid_cols; ++column) {
      const int x = column * half.cols / options.grid_cols;
      const int y = row * half.rows / options.grid_rows;
      const cv::Rect cell = cv::Rect(x, y, (column + 1) * half.cols / options.grid_cols - x,
                                     (row + 1) * half.rows / options.grid_rows - y) &
                            usable;
      int& count = held[static_cast<std::size_t>(row) * static_cast<std::size_t>(options.grid_cols) +
                        static_cast<std::size_t>(column)];
      if (cell.width < 3 || cell.height < 3 || count >= options.features_per_cell) continue;
      cv::cornerMinEigenVal(half(cell), response, kBlock, 3);
      for (const Candidate& c : candidates_in(response, cell, threshold)) {
        if (count >= options.features_per_cell) break;
        if (occupancy.taken(c.x, c.y)) continue;
        occupancy.take(c.x, c.y);
        ++count;
        corners.push_back(
            {Eigen::Vector2f(static_cast<float>(c.x), static_cast<float>(c.y)), noise_sigma_px(c.response, noise_dn)});
      }
    }
  }
  return corners;
}

}  // namespace plumbline
