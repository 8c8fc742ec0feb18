#include "tools/formats/plumbline_dataset.h"

#include <fstream>

#include "scenarios/input_error.h"
#include "tools/formats/dataset_calibration.h"
#include "tools/formats/message_stream.h"
#include "tools/formats/output_file.h"
#include "tools/formats/truth_file.h"
#include "tools/formats/tum.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMessages = "messages.plb";
constexpr const char* kTruth = "ground_truth.tum";

/// An open stream and what reads it.
class StreamFile {
 public:
  explicit StreamFile(const fs::path& path) : stream_(opened(path)), reader_(stream_, path.string()) {}

  const Calibration& calibration() const { return reader_.calibration(); }
  std::unique_ptr<SensorMessage> next() {
    auto message = reader_.read();
    return message ? std::make_unique<SensorMessage>(std::move(*message)) : nullptr;
  }

 private:
  static std::ifstream opened(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) throw InputError(path.string() + ": no such file");
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw InputError(path.string() + ": cannot be read");
    return stream;
  }

  std::ifstream stream_;
  MessageStreamReader reader_;
};

class PlumblineWriter final : public DatasetWriter {
 public:
  PlumblineWriter(const fs::path& directory, const Calibration& calibration)
      : directory_(directory), messages_(directory / kMessages) {
    messages_.write(message_stream_header(calibration));
  }

  void write(const SensorMessage& message) override {
    messages_.write(message_record(message.payload, message.delivery_ns));
  }

  void finish(const std::vector<PoseTrack::Stamped>& truth) override {
    messages_.write(message_end_record());
    messages_.close();
    if (!truth.empty()) write_whole_file(directory_ / kTruth, tum_text(truth));
  }

 private:
  fs::path directory_;
  OutputFile messages_;
};

}  // namespace

Dataset open_plumbline_dataset(const fs::path& path, const DatasetSettings& settings) {
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  Dataset dataset;
  if (!settings.truth.empty()) {
    dataset.recording.truth = read_truth_file(settings.truth);
  } else if (is_folder && fs::exists(path / kTruth)) {
    dataset.recording.truth = read_truth_file(path / kTruth);
  }
  auto file = std::make_shared<StreamFile>(is_folder ? path / kMessages : path);
  dataset.calibration = complete_calibration(file->calibration(), {}, settings);
  dataset.recording.messages = [file = std::move(file)] { return file->next(); };
  if (!dataset.recording.truth.empty()) {
    dataset.recording.start_ns = dataset.recording.truth.front().stamp_ns;
    dataset.recording.end_ns = dataset.recording.truth.back().stamp_ns;
  }
  return dataset;
}

std::unique_ptr<DatasetWriter> make_plumbline_writer(const fs::path& directory, const Calibration& calibration) {
  return std::make_unique<PlumblineWriter>(directory, calibration);
}

}  // namespace plumbline
