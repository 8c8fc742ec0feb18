#include "tools/formats/png.h"

#include <spng.h>

#include <cstdlib>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

namespace plumbline {
namespace {

constexpr std::size_t kMostChunkBytes = std::size_t{1} << 20;  // of what is no pixel: texts, profiles

struct FreeContext {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, FreeContext>;

Context make_context(int flags) {
  Context context(spng_ctx_new(flags));
  if (!context) throw std::bad_alloc();
  return context;
}

void check(int status) {
  if (status != SPNG_OK) throw std::invalid_argument(spng_strerror(status));
}

std::uint8_t colour_type_of(const cv::Mat& image) {
  switch (image.channels()) {
    case 1:
      return SPNG_COLOR_TYPE_GRAYSCALE;
    case 3:
      return SPNG_COLOR_TYPE_TRUECOLOR;
    default:
      return SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
  }
}

/// Rows without gaps, red first.
cv::Mat as_png_has_it(const cv::Mat& image) {
  if (image.channels() == 1) return image.isContinuous() ? image : image.clone();
  cv::Mat turned;
  cv::cvtColor(image, turned, image.channels() == 3 ? cv::COLOR_BGR2RGB : cv::COLOR_BGRA2RGBA);
  return turned;
}

}  // namespace

cv::Mat decode_png(std::span<const char> file, int longest_side) {
  const Context context = make_context(0);
  const auto most = static_cast<std::uint32_t>(longest_side);
  check(spng_set_chunk_limits(context.get(), kMostChunkBytes, kMostChunkBytes));
  check(spng_set_png_buffer(context.get(), file.data(), file.size()));
  spng_ihdr header{};
  check(spng_get_ihdr(context.get(), &header));
  if (header.width > most || header.height > most) {
    throw std::invalid_argument("found an image of " + std::to_string(header.width) + " x " +
                                std::to_string(header.height) + ", allowed are sides to " +
                                std::to_string(longest_side));
  }
  const bool grey = header.color_type == SPNG_COLOR_TYPE_GRAYSCALE;
  const bool deep = grey && header.bit_depth == 16;
  const int format = deep ? SPNG_FMT_PNG : grey ? SPNG_FMT_G8 : SPNG_FMT_RGB8;
  cv::Mat image(static_cast<int>(header.height), static_cast<int>(header.width),
                deep   ? CV_16UC1
                : grey ? CV_8UC1
                       : CV_8UC3);
  check(spng_decode_image(context.get(), image.data, image.total() * image.elemSize(), format, 0));
  check(spng_decode_chunks(context.get()));  // the last pixels' checksum is read with what follows them
  if (!grey) cv::cvtColor(image, image, cv::COLOR_RGB2BGR);
  return image;
}

std::vector<std::uint8_t> encode_png(const cv::Mat& image, int effort) {
  const cv::Mat pixels = as_png_has_it(image);
  const Context context = make_context(SPNG_CTX_ENCODER);
  check(spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1));
  check(spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, effort));
  check(spng_set_option(context.get(), SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_SUB));
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(pixels.cols);
  header.height = static_cast<std::uint32_t>(pixels.rows);
  header.bit_depth = pixels.depth() == CV_16U ? 16 : 8;
  header.color_type = colour_type_of(pixels);
  check(spng_set_ihdr(context.get(), &header));
  check(spng_encode_image(context.get(), pixels.data, pixels.total() * pixels.elemSize(), SPNG_FMT_PNG,
                          SPNG_ENCODE_FINALIZE));
  std::size_t size = 0;
  int status = SPNG_OK;
  const std::unique_ptr<void, decltype(&std::free)> buffer(spng_get_png_buffer(context.get(), &size, &status),
                                                           &std::free);
  check(status);
  const auto* bytes = static_cast<const std::uint8_t*>(buffer.get());
  return {bytes, bytes + size};
}

}  // namespace plumbline
