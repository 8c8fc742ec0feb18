#include "tools/formats/image_file.h"

#include <cstring>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "scenarios/input_error.h"
#include "tools/formats/output_file.h"
#include "tools/formats/png.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

constexpr std::uintmax_t kMostFileBytes = std::uintmax_t{256} << 20;

constexpr int kPngEffort = 1;  // camera images are noise: hard to squeeze, and level 1 leaves a few percent at most

cv::Mat decoded(const std::filesystem::path& path) {
  try {
    return decode_png(read_bounded_file(path, kMostFileBytes), kMostImageSide);
  } catch (const std::invalid_argument& error) {
    throw InputError(path.string() + ": no image that can be read: " + error.what());
  }
}

void write_png(const std::filesystem::path& path, const cv::Mat& image) {
  const std::vector<std::uint8_t> png = encode_png(image, kPngEffort);
  write_whole_file(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

/// 8-bit grey, colours weighed as for the eye.
cv::Mat as_grey(const cv::Mat& image) {
  if (image.type() == CV_8UC1) return image;
  cv::Mat grey;
  if (image.type() == CV_8UC3) {
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  } else {
    image.convertTo(grey, CV_8U, 1.0 / 257.0);
  }
  return grey;
}

template <typename Pixel>
void check_pixels(const std::filesystem::path& path, int width, int height, const std::vector<Pixel>& pixels) {
  const bool whole =
      width > 0 && height > 0 && pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (!whole) throw std::runtime_error(path.string() + ": the image's size is not that of its pixels");
}

}  // namespace

CameraFrame read_grey_image(const std::filesystem::path& path) {
  const cv::Mat image = as_grey(decoded(path));
  CameraFrame frame;
  frame.width = image.cols;
  frame.height = image.rows;
  frame.pixels.assign(image.datastart, image.dataend);
  return frame;
}

DepthImage read_depth_image(const std::filesystem::path& path) {
  const cv::Mat image = decoded(path);
  if (image.type() != CV_16UC1) throw InputError(path.string() + ": expected a 16-bit image of one channel");
  DepthImage depth{image.cols, image.rows, std::vector<std::uint16_t>(image.total())};
  std::memcpy(depth.values.data(), image.data, depth.values.size() * sizeof(std::uint16_t));
  return depth;
}

void write_grey_image(const std::filesystem::path& path, const CameraFrame& frame) {
  check_pixels(path, frame.width, frame.height, frame.pixels);
  // OpenCV takes pixels to be written by a pointer that is not const.
  write_png(path, cv::Mat(frame.height, frame.width, CV_8UC1, const_cast<std::uint8_t*>(frame.pixels.data())));
}

void write_depth_image(const std::filesystem::path& path, const DepthImage& image) {
  check_pixels(path, image.width, image.height, image.values);
  write_png(path, cv::Mat(image.height, image.width, CV_16UC1, const_cast<std::uint16_t*>(image.values.data())));
}

}  // namespace plumbline
