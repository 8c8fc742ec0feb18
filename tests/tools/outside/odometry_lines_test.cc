#include "tools/outside/odometry_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

namespace plumbline {
namespace {

using ::testing::HasSubstr;

Odometry full_odometry() {
  Odometry o;
  o.stamp_ns = -7;
  o.world_from_body = {Eigen::Quaterniond(0.1, 0.2, 0.3, 0.4).normalized(), {1.0 / 3.0, -1e-17, 1e6}};
  o.velocity_in_world = {0.1, -0.0, 3.0};
  o.gyro_bias = {1e-300, 2.0, 3.0};
  o.accel_bias = {4.0, 5.0, 6.0};
  o.covariance = Matrix6d::Random();
  o.increment_covariance = Matrix6d::Random();
  o.lost = true;
  ModuleHealth health;
  health.stamp_ns = 3;
  health.module = Module::kLidar;
  health.mode = ModuleMode::kPartial;
  health.eigenvalues = Vector6d::Random();
  health.eigenvectors = Matrix6d::Random();
  health.well_conditioned = 5;
  health.rows = 100;
  health.inliers = 90;
  health.correction = Vector6d::Random();
  health.processing_s = 0.01;
  o.health = {health, health};
  return o;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string line_complaint(const std::string& line) {
  try {
    OdometryLines().add(line);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

std::string closing_complaint(const std::string& line) {
  try {
    ClosingLines().add(line);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(OdometryLines, GiveEveryBitBack) {
  const Odometry written = full_odometry();
  const std::string text = odometry_lines(written);
  OdometryLines reader;
  const std::vector<std::string> lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(reader.add(lines[i]), i + 1 == lines.size());
  const Odometry found = reader.take();
  EXPECT_EQ(odometry_lines(found), text);
  EXPECT_EQ(found.covariance, written.covariance);
  EXPECT_EQ(found.health.at(1).eigenvectors, written.health[1].eigenvectors);
  EXPECT_FALSE(OdometryLines(reader).take().lost) << "the next output begins anew";
}

TEST(OdometryLines, APoseIsEnough) {
  OdometryLines reader;
  EXPECT_TRUE(reader.add("pose 5000000 1 2.5 -3e-2 0 0 0.707107 0.707107"));
  const Odometry found = reader.take();
  EXPECT_EQ(found.stamp_ns, 5'000'000);
  EXPECT_NEAR(found.world_from_body.rotation.norm(), 1.0, 1e-15);
}

TEST(OdometryLines, RefuseWhatIsNoAnswer) {
  EXPECT_THAT(line_complaint("pose 5 1 2 nan 0 0 0 1"), HasSubstr("found 'nan', expected a finite number"));
  EXPECT_THAT(line_complaint("pose 5 1 2 1e999 0 0 0 1"), HasSubstr("found '1e999'"));
  EXPECT_THAT(line_complaint("pose 5 1 2 3 0 0 0"), HasSubstr("a field is missing"));
  EXPECT_THAT(line_complaint("pose 5 1 2 3 0 0 0 1 9"), HasSubstr("more fields"));
  EXPECT_THAT(line_complaint("pose 5.0 1 2 3 0 0 0 1"), HasSubstr("found '5.0', expected a whole number"));
  EXPECT_THAT(line_complaint("pose 5 1 2 3 0 0 0 0"), HasSubstr("unit length"));
  EXPECT_THAT(line_complaint("pose 5 1 2 1e12 0 0 0 1"), HasSubstr("within 1e9 m"));
  EXPECT_THAT(line_complaint("hello world"), HasSubstr("wrote the line 'hello world'"));
  EXPECT_THAT(line_complaint(""), HasSubstr("expected a pose"));
  EXPECT_THAT(line_complaint("\x01\xff" + std::string(1000, 'x')), HasSubstr("'??xxx"));
  EXPECT_THAT(line_complaint("health 5 sonar"), HasSubstr("found the word 'sonar'"));
}

TEST(ClosingLines, CountsAndMap) {
  const MessageCounts counts{7, {{"back in time", 2}, {"empty", 1}}};
  MapPoint grey{{1.0F, 2.0F, 0.1F}, 0.5F, false, {}};
  MapPoint red{{0.0F, 0.0F, 0.0F}, 1.0F, true, {255, 0, 1}};
  ClosingLines closing;
  for (const std::string& line : lines_of(counts_lines(Module::kLidar, counts) + point_line(grey) + point_line(red))) {
    closing.add(line);
  }
  EXPECT_EQ(closing.counts.at(Module::kLidar).used, 7);
  EXPECT_EQ(closing.counts.at(Module::kLidar).dropped, counts.dropped);
  EXPECT_EQ(closing.counts.size(), 1U);
  ASSERT_EQ(closing.map.size(), 2U);
  EXPECT_EQ(closing.map[0].position, grey.position);
  EXPECT_FALSE(closing.map[0].coloured);
  EXPECT_EQ(closing.map[1].colour, red.colour);

  EXPECT_THAT(closing_complaint("used lidar -1"), HasSubstr("not negative"));
  EXPECT_THAT(closing_complaint("dropped lidar 1"), HasSubstr("a reason is missing"));
  EXPECT_THAT(closing_complaint("point 1 2 3"), HasSubstr("a field is missing"));
  EXPECT_THAT(closing_complaint("point 1 2 1e300 0"), HasSubstr("beyond all sense"));
  EXPECT_THAT(closing_complaint("point 1 2 3 0 1 2 256"), HasSubstr("from 0 to 255"));
  EXPECT_THAT(closing_complaint("pose 5 1 2 3 0 0 0 1"), HasSubstr("after the last message"));
}

TEST(Greeting, OfThisVersionOnly) {
  EXPECT_EQ(read_greeting("plumbline-odometry 1"), std::optional(false));
  EXPECT_EQ(read_greeting("plumbline-odometry 1 acknowledge"), std::optional(true));
  EXPECT_EQ(read_greeting("plumbline-odometry 2"), std::nullopt);
}

}  // namespace
}  // namespace plumbline
