#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace cv {
class Mat;
}

namespace plumbline {

/// PNG by libspng. OpenCV's codecs would do, but a program that links them loads a hundred libraries more at every
/// start, and decodes whatever format a hostile file names.

/// Grey of 8 bits or less as CV_8UC1, grey of 16 bits as CV_16UC1, everything else as CV_8UC3 (blue first, as OpenCV
/// has it; without transparency).
/// @throws std::invalid_argument saying what is wrong: no PNG, a damaged one, or a side longer than `longest_side`
cv::Mat decode_png(std::span<const char> file, int longest_side);

/// @param image  CV_8UC1, CV_16UC1, CV_8UC3 (blue first) or CV_8UC4
/// @param effort  zlib's level: 1 for noise, which no effort makes small
std::vector<std::uint8_t> encode_png(const cv::Mat& image, int effort);

}  // namespace plumbline
