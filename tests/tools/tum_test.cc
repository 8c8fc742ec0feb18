#include "tools/formats/tum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "estimator/geometry/so3.h"
#include "scenarios/scenario.h"

namespace plumbline {
namespace {

class Tum : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / (std::string("plumbline_tum_") + info->name() + ".txt");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  std::string error_of(const std::string& content) {
    std::ofstream(path_, std::ios::binary) << content;
    try {
      read_tum(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path path_;
};

TEST_F(Tum, GivesBackWhatWasWritten) {
  const std::vector<PoseTrack::Stamped> poses = {{5'000'000, {exp_so3({0.1, 0.2, 0.3}), {1.25, -2.5, 1e-9}}},
                                                 {1'403'636'579'763'555'584, {exp_so3({3.0, 0.0, 0.0}), {9e6, 0, 0}}}};
  std::ofstream(path_) << tum_text(poses);
  const auto found = read_tum(path_);
  ASSERT_EQ(found.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(found[i].stamp_ns, poses[i].stamp_ns);  // to the nanosecond
    EXPECT_LT(poses[i].pose.local(found[i].pose).norm(), 1e-8);
  }
}

TEST_F(Tum, ReadsCommentsTabsCarriageReturnsAndExponents) {
  std::ofstream(path_) << "# a comment\r\n\r\n-0.5\t0 0 0  0 0 0 1\r\n1e0 1e-3 +2 0 0 0 0 -1";
  const auto found = read_tum(path_);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].stamp_ns, -500'000'000);
  EXPECT_EQ(found[1].stamp_ns, 1'000'000'000);
  EXPECT_DOUBLE_EQ(found[1].pose.translation.x(), 1e-3);
}

TEST_F(Tum, NamesFileAndLineOfWhatItCannotUse) {
  const std::string good = "# stamp x y z qx qy qz qw\n0.0 0 0 0 0 0 0 1\n";
  const std::string place = path_.string() + ":3: ";
  const std::vector<std::pair<std::string, std::string>> hostile = {
      {"1.0 0 0 0 0 0 1", "found 7 values"},
      {"1.0 0 0 0 0 0 0 1 9", "found 9 values"},
      {"1.0 nan 0 0 0 0 0 1", "'nan' is not a finite number"},
      {"1.0 inf 0 0 0 0 0 1", "'inf' is not a finite number"},
      {"1.0 1e999 0 0 0 0 0 1", "'1e999' is not a finite number"},
      {"1.0 1e20 0 0 0 0 0 1", "out of range"},
      {"1.0 0 0 0 0 0 0 0", "quaternion has norm 0"},
      {"1.0 0 0 0 1 1 1 1", "quaternion has norm 2.00"},
      {"0.0 0 0 0 0 0 0 1", "not later than the one before"},
      {"nan 0 0 0 0 0 0 1", "stamp 'nan'"},
      {"99999999999999999999 0 0 0 0 0 0 1", "stamp '99999999999999999999'"},
      {"1.0x 0 0 0 0 0 0 1", "stamp '1.0x'"},
      {std::string(5000, '1'), "longer than 1024 bytes"},
      {std::string("\x01\xff\0 0 0 0 0 0 0 1", 18), "stamp '?\?\?'"},
  };
  for (const auto& [line, complaint] : hostile) {
    EXPECT_THAT(error_of(good + line + "\n"),
                ::testing::AllOf(::testing::StartsWith(place), ::testing::HasSubstr(complaint)));
  }
}

TEST_F(Tum, NamesAFileThatHoldsNothingOrIsNotThere) {
  EXPECT_THAT(error_of(""), ::testing::HasSubstr(path_.string() + ": holds no pose"));
  EXPECT_THROW(read_tum(path_.parent_path()), InputError);
  EXPECT_THROW(read_tum(path_.string() + ".missing"), InputError);
}

}  // namespace
}  // namespace plumbline
