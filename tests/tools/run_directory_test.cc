#include "tools/output/run_directory.h"

#include <gtest/gtest.h>

#include <fstream>

#include "scenarios/scenario.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

class RunDirectoryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::temp_directory_path() / (std::string("plumbline_run_directory_") + info->name());
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }

  void put(const fs::path& file, const std::string& content) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << content;
  }
  std::string content_of(const fs::path& file) const {
    std::ifstream stream(root_ / file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(root_), fs::directory_iterator{}));
  }
  void run_into(const fs::path& target, const std::string& result) const {
    RunDirectory directory(root_ / target);
    directory.open();
    directory.write("result.json", result);
    directory.commit();
  }

  fs::path root_;
};

TEST_F(RunDirectoryTest, AppearsWholeWithItsParents) {
  run_into("a/b/run-1/", "{}");
  EXPECT_EQ(content_of("a/b/run-1/result.json"), "{}");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(RunDirectoryTest, ReplacesAnEarlierRunWhole) {
  put("run/result.json", "old");
  put("run/left_over.txt", "old");
  run_into("run", "new");
  EXPECT_EQ(content_of("run/result.json"), "new");
  EXPECT_FALSE(fs::exists(root_ / "run/left_over.txt"));
  EXPECT_EQ(entries(), 1U);
}

TEST_F(RunDirectoryTest, TakesAnEmptyDirectory) {
  fs::create_directory(root_ / "run");
  run_into("run", "new");
  EXPECT_EQ(content_of("run/result.json"), "new");
}

TEST_F(RunDirectoryTest, RefusesWhatIsNoRun) {
  put("thesis/chapter.txt", "years of work");
  EXPECT_THROW(RunDirectory(root_ / "thesis"), InputError);
  EXPECT_THROW(RunDirectory(root_ / "thesis/chapter.txt"), InputError);
  EXPECT_EQ(content_of("thesis/chapter.txt"), "years of work");
}

TEST_F(RunDirectoryTest, RefusesAPlaceWhereItCannotWrite) {
  put("file", "not a directory");
  RunDirectory directory(root_ / "file/run");
  EXPECT_THROW(directory.open(), InputError);
}

TEST_F(RunDirectoryTest, LeavesNothingBehindWhenItIsNotCommitted) {
  put("run/result.json", "old");
  {
    RunDirectory directory(root_ / "run");
    directory.open();
    directory.write("result.json", "half");
  }
  EXPECT_EQ(content_of("run/result.json"), "old");
  EXPECT_EQ(entries(), 1U);
}

}  // namespace
}  // namespace plumbline
