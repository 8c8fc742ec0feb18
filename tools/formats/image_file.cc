#include "tools/formats/image_file.h"

#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "scenarios/input_error.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

constexpr std::uintmax_t kMostFileBytes = std::uintmax_t{256} << 20;

// Hard to squeeze for its size: noise. Level 1 costs a fifth of the default's time and a few percent of size.
const std::vector<int> kFastPng{cv::IMWRITE_PNG_COMPRESSION, 1};

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// A PNG's header is looked at before its decoder is let loose on it; what else OpenCV reads, it bounds by itself.
void check_png_size(const std::filesystem::path& path, const std::string& bytes) {
  constexpr std::size_t kWidthAt = 16;
  constexpr std::size_t kHeightAt = 20;
  if (bytes.compare(0, 4, "\x89PNG") != 0 || bytes.size() < kHeightAt + 4) return;
  const std::uint32_t width = big_endian(bytes, kWidthAt);
  const std::uint32_t height = big_endian(bytes, kHeightAt);
  if (width <= kMostImageSide && height <= kMostImageSide) return;
  throw InputError(path.string() + ": found an image of " + std::to_string(width) + " x " + std::to_string(height) +
                   ", allowed are sides to " + std::to_string(kMostImageSide));
}

cv::Mat decoded(const std::filesystem::path& path, int flags) {
  const std::string bytes = read_bounded_file(path, kMostFileBytes);
  check_png_size(path, bytes);
  cv::Mat image;
  try {
    if (!bytes.empty()) image = cv::imdecode(std::vector<char>(bytes.begin(), bytes.end()), flags);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) throw InputError(path.string() + ": no image that can be read");
  if (image.cols > kMostImageSide || image.rows > kMostImageSide) {
    throw InputError(path.string() + ": found an image of " + std::to_string(image.cols) + " x " +
                     std::to_string(image.rows) + ", allowed are sides to " + std::to_string(kMostImageSide));
  }
  return image.isContinuous() ? image : image.clone();
}

void write_png(const std::filesystem::path& path, const cv::Mat& image) {
  bool written = false;
  try {
    written = cv::imwrite(path.string(), image, kFastPng);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) throw std::runtime_error(path.string() + ": cannot be written");
}

template <typename Pixel>
void check_pixels(const std::filesystem::path& path, int width, int height, const std::vector<Pixel>& pixels) {
  const bool whole =
      width > 0 && height > 0 && pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (!whole) throw std::runtime_error(path.string() + ": the image's size is not that of its pixels");
}

}  // namespace

CameraFrame read_grey_image(const std::filesystem::path& path) {
  const cv::Mat image = decoded(path, cv::IMREAD_GRAYSCALE);
  CameraFrame frame;
  frame.width = image.cols;
  frame.height = image.rows;
  frame.pixels.assign(image.datastart, image.dataend);
  return frame;
}

DepthImage read_depth_image(const std::filesystem::path& path) {
  const cv::Mat image = decoded(path, cv::IMREAD_UNCHANGED);
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
