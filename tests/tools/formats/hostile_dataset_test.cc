#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/scenarios/temporary_directory.h"
#include "tests/tools/formats/input_message.h"
#include "tests/tools/formats/synthetic_messages.h"
#include "tools/formats/dataset_calibration.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;

/// A dataset of any format in which something is then spoilt.
class HostileDataset : public ::testing::Test {
 protected:
  void make(const std::string& format) {
    format_ = format;
    const SyntheticSession session = synthetic_session();
    const auto writer = make_dataset_writer(format, directory_.path(), synthetic_calibration());
    for (const SensorMessage& message : session.messages) writer->write(message);
    writer->finish(session.truth);
  }

  fs::path path(const std::string& name) const { return directory_.path() / name; }
  void write(const std::string& name, const std::string& bytes) const { directory_.write(name, bytes); }
  std::string content(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string complaint() const {
    return input_message_of([&] { drained(open_dataset(format_, directory_.path(), {}).recording.messages); });
  }

  TemporaryDirectory directory_;
  std::string format_;
};

TEST_F(HostileDataset, ListsMayNotLeadOutOfTheDataset) {
  make("tum");
  for (const char* name : {"../secret.png", "rgb/../../secret.png", "/etc/passwd"}) {
    write("rgb.txt", std::string("0.1 ") + name + "\n");
    EXPECT_THAT(complaint(), HasSubstr("expected a path within the dataset")) << name;
  }
  make("euroc");
  write("mav0/cam0/data.csv", "#t,f\n1,../../../secret.png\n");
  EXPECT_THAT(complaint(), HasSubstr("expected a path within the dataset"));
}

TEST_F(HostileDataset, TablesAreReadStrictly) {
  make("euroc");
  const std::string imu = content("mav0/imu0/data.csv");
  write("mav0/imu0/data.csv", imu + "5,nan,0,0,0,0,0\n");
  EXPECT_THAT(complaint(), HasSubstr("data.csv:62: 'nan' is not a finite number"));
  write("mav0/imu0/data.csv", imu + "5,0,0\n");
  EXPECT_THAT(complaint(), HasSubstr("data.csv:62: found 3 values, expected at least"));
  write("mav0/imu0/data.csv", imu + "1e9,0,0,0,0,0,0\n");
  EXPECT_THAT(complaint(), HasSubstr("'1e9' is not a whole number"));
  write("mav0/imu0/data.csv", imu + std::string(5000, '1') + "\n");
  EXPECT_THAT(complaint(), HasSubstr("longer than 4096 bytes"));
}

TEST_F(HostileDataset, EurocSensorsAreReadStrictly) {
  make("euroc");
  fs::remove(path(kDatasetCalibration));
  EXPECT_EQ(complaint(), "");
  const std::string camera = content("mav0/cam0/sensor.yaml");
  write("mav0/cam0/sensor.yaml", "%YAML:1.0\n" + camera);
  EXPECT_EQ(complaint(), "");
  write("mav0/cam0/sensor.yaml", camera + "distortion_model: equidistant\n");
  EXPECT_NE(complaint(), "");
  write("mav0/cam0/sensor.yaml", "resolution: [1e9, 12]\n");
  EXPECT_THAT(complaint(), HasSubstr("resolution"));
  write("mav0/cam0/sensor.yaml", "T_BS: [1, 2]\n");
  EXPECT_NE(complaint(), "");
}

TEST_F(HostileDataset, DepthImagesMustHaveSixteenBits) {
  make("tum");
  const std::string rgb = content("rgb.txt");
  write("depth.txt", rgb);
  EXPECT_THAT(complaint(), HasSubstr("expected a 16-bit image of one channel"));
}

TEST_F(HostileDataset, BagsCutAnywhereAreRefused) {
  for (const auto& [format, file] : {std::pair("rosbag", "data.bag"), std::pair("rosbag2", "data_0.db3")}) {
    make(format);
    const std::string whole = content(file);
    for (const double share : {0.0, 0.01, 0.5, 0.99}) {
      write(file, whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
      EXPECT_THAT(complaint(), HasSubstr(file)) << format << " cut to " << share;
    }
    for (const auto& entry : fs::directory_iterator(directory_.path())) fs::remove_all(entry.path());
  }
}

TEST_F(HostileDataset, TheFilesOfABagLieWithinIt) {
  make("rosbag2");
  write("metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths: [../data_0.db3]\n");
  EXPECT_THAT(complaint(), HasSubstr("expected a path within the dataset"));
  write("metadata.yaml", "rosbag2_bagfile_information:\n  compression_format: zstd\n  relative_file_paths: [a]\n");
  EXPECT_THAT(complaint(), HasSubstr("compressed (zstd)"));
  write("metadata.yaml", "rosbag2_bagfile_information: 7\n");
  EXPECT_NE(complaint(), "");
}

TEST_F(HostileDataset, ABagWithoutTheTopicsSaysSo) {
  make("rosbag2");
  DatasetSettings settings;
  settings.topics = {"/a", "/b", "/c", "/d", "/e", "/f"};
  EXPECT_THAT(input_message_of([&] { open_dataset("rosbag2", directory_.path(), settings); }),
              HasSubstr("holds none of the topics /a, /b, /e"));
}

TEST_F(HostileDataset, AStreamCutShortIsRefused) {
  make("plumbline");
  const std::string whole = content("messages.plb");
  write("messages.plb", whole.substr(0, whole.size() - 1));
  EXPECT_THAT(complaint(), HasSubstr("cut short"));
}

}  // namespace
}  // namespace plumbline
