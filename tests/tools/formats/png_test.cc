#include "tools/formats/png.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <span>
#include <stdexcept>
#include <string>

namespace plumbline {
namespace {

/// 23 by 7 pixels, none like its neighbours.
cv::Mat picture(int type) {
  cv::Mat image(7, 23, type);
  const std::size_t bytes = image.total() * image.elemSize();
  for (std::size_t i = 0; i < bytes; ++i) image.data[i] = static_cast<std::uint8_t>(37 * i + i / 11);
  return image;
}

std::string file_of(const cv::Mat& image) {
  const auto png = encode_png(image, 1);
  return {png.begin(), png.end()};
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.type() == b.type() && a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

TEST(Png, ComesBackAsItWas) {
  for (const int type : {CV_8UC1, CV_16UC1, CV_8UC3}) {
    const cv::Mat image = picture(type);
    EXPECT_TRUE(same(decode_png(file_of(image), 23), image)) << type;
  }
  // Rows of a part lie apart in memory.
  const cv::Mat part = picture(CV_8UC3)(cv::Rect(3, 1, 9, 5));
  EXPECT_TRUE(same(decode_png(file_of(part), 23), part));
}

TEST(Png, TransparencyIsLeftOut) {
  const cv::Mat image = picture(CV_8UC4);
  const cv::Mat seen = decode_png(file_of(image), 23);
  ASSERT_EQ(seen.type(), CV_8UC3);
  EXPECT_EQ(seen.at<cv::Vec3b>(4, 9)[0], image.at<cv::Vec4b>(4, 9)[0]);
  EXPECT_EQ(seen.at<cv::Vec3b>(4, 9)[2], image.at<cv::Vec4b>(4, 9)[2]);
}

TEST(Png, WhatIsDamagedOrTooLargeIsRefused) {
  const std::string file = file_of(picture(CV_16UC1));
  EXPECT_NO_THROW(decode_png(file, 23));
  EXPECT_THROW(decode_png(file, 22), std::invalid_argument);
  // The last chunk, of twelve bytes, holds nothing.
  for (std::size_t size = 0; size + 12 < file.size(); ++size) {
    EXPECT_THROW(decode_png(std::span(file).first(size), 23), std::invalid_argument) << size;
  }
  for (std::size_t at = 0; at + 12 < file.size(); ++at) {
    std::string damaged = file;
    damaged[at] = static_cast<char>(~damaged[at]);
    EXPECT_THROW(decode_png(damaged, 23), std::invalid_argument) << at;
  }
}

}  // namespace
}  // namespace plumbline
