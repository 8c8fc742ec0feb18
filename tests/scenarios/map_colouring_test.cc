#include "scenarios/map_colouring.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// Red to the left, blue to the right, at full light.
RawImage two_halves() {
  RawImage raw;
  raw.width = kWidth;
  raw.height = kHeight;
  raw.channels = 3;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const bool left = i % kWidth < kWidth / 2;
    for (const bool lit : {left, false, !left}) raw.counts.push_back(lit ? 1023 : 16);
  }
  return raw;
}

ColourView view_of(const RawImage& raw, const Pose& map_from_camera = {}) {
  return {raw, 4.0, {kWidth, kHeight, 40.0, 40.0, 31.5, 23.5, {}}, map_from_camera};
}

MapPoint point(float x, float y, float z) {
  MapPoint p;
  p.position = {x, y, z};
  return p;
}

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kRed{255, 0, 0};
constexpr Colour kBlue{0, 0, 255};

TEST(MapColouring, TakesTheColourOfThePixelAPointFallsOn) {
  const RawImage raw = two_halves();
  std::vector<MapPoint> points{point(-1, 0, 4), point(1, 0, 4), point(0, 0, -4), point(9, 0, 4)};
  MapColouring(points).add(view_of(raw));
  EXPECT_EQ(points[0].colour, kRed);
  EXPECT_EQ(points[1].colour, kBlue);
  EXPECT_FALSE(points[2].coloured);  // behind
  EXPECT_FALSE(points[3].coloured);  // beside
}

TEST(MapColouring, LeavesOutWhatIsHidden) {
  const RawImage raw = two_halves();
  std::vector<MapPoint> points{point(-1, 0, 4), point(-2, 0, 8), point(-1.05F, 0, 4.3F)};
  MapColouring(points).add(view_of(raw));
  EXPECT_TRUE(points[0].coloured);
  EXPECT_FALSE(points[1].coloured);  // right behind the first
  EXPECT_TRUE(points[2].coloured);   // of one surface with it
}

TEST(MapColouring, TheNearestFrameDecides) {
  const RawImage raw = two_halves();
  std::vector<MapPoint> points{point(0.5F, 0, 4)};
  MapColouring colouring(points);
  colouring.add(view_of(raw));
  EXPECT_EQ(points[0].colour, kBlue);
  colouring.add(view_of(raw, {Eigen::Quaterniond::Identity(), {1.0, 0.0, 2.0}}));  // now to the left, and nearer
  EXPECT_EQ(points[0].colour, kRed);
  colouring.add(view_of(raw));
  EXPECT_EQ(points[0].colour, kRed);
}

}  // namespace
}  // namespace plumbline
