#include "tools/outside/outside_estimator.h"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "scenarios/estimator_fault.h"
#include "scenarios/input_error.h"
#include "tools/exit_code.h"
#include "tools/formats/message_stream.h"
#include "tools/formats/number_text.h"
#include "tools/outside/odometry_lines.h"
#include "tools/outside/outside_process.h"

namespace plumbline {
namespace {

/// The talk with the program, from the header to its end.
class Conversation {
 public:
  Conversation(const OutsideCommand& command, const Calibration& calibration)
      : name_(command.name),
        process_(std::make_unique<OutsideProcess>(command.words, command.directory, command.silence_limit)),
        header_(message_stream_header(calibration)) {
    if (!command.is_host) return;
    try {
      greet();
    } catch (const EstimatorFault& fault) {
      if (process_->exit_code() == kExitBadInput) throw InputError(name_ + ": " + fault.what());
      // Any other end is the run's fault, which the first message finds.
    }
  }

  template <typename Message>
  void tell(Module module, const Message& message, std::int64_t stamp_ns) {
    newest_ns_ = std::max(newest_ns_, stamp_ns);
    std::string record;
    try {
      record = message_record(message, newest_ns_);
    } catch (const std::invalid_argument&) {
      ++counts_[module].dropped["malformed"];
      return;
    }
    guarded("at the message stamped ", stamp_ns, [&] {
      greet();
      process_->send(record);
      if constexpr (std::is_same_v<Message, ImuSample>) {
        read_answer(stamp_ns);
      } else if (acknowledges_) {
        read_done();
      }
    });
    ++counts_[module].used;
  }

  std::vector<Odometry> take() { return std::exchange(outputs_, {}); }

  const MessageCounts& counts(Module module) {
    finish();
    return counts_[module];
  }
  const std::vector<MapPoint>& map() {
    finish();
    return map_;
  }

 private:
  /// One failure ends the talk.
  template <typename Call>
  void guarded(const char* where, std::int64_t stamp_ns, Call call) {
    if (!process_) return;
    const auto fail = [&](const std::string& what) {
      process_.reset();
      std::string place = where;
      append_seconds(place, stamp_ns);
      throw EstimatorFault(name_ + ", " + place + " s: " + what);
    };
    try {
      call();
    } catch (const EstimatorFault& fault) {
      fail(fault.what());
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
  }

  void greet() {
    if (header_.empty()) return;
    process_->send(std::exchange(header_, {}));
    const std::string line = process_->read_line();
    const auto acknowledges = read_greeting(line);
    if (!acknowledges) throw std::invalid_argument(unexpected(line, "its first line to be '" + greeting() + "'"));
    acknowledges_ = *acknowledges;
  }

  void read_answer(std::int64_t stamp_ns) {
    for (;;) {
      const std::string line = process_->read_line();
      if (line == kNoPose) return;
      if (!lines_.add(line)) continue;
      outputs_.push_back(lines_.take());
      if (outputs_.back().stamp_ns == stamp_ns) return;
      throw std::invalid_argument("answered with a pose stamped " + std::to_string(outputs_.back().stamp_ns) +
                                  " ns to the sample stamped " + std::to_string(stamp_ns) + " ns");
    }
  }

  void read_done() {
    const std::string line = process_->read_line();
    if (line != kDone) throw std::invalid_argument(unexpected(line, kDone));
  }

  void finish() {
    guarded("after the message stamped ", newest_ns_, [&] {
      greet();
      process_->send(message_end_record());
      process_->close_input();
      ClosingLines closing;
      while (const auto line = process_->read_line_or_end()) closing.add(*line);
      process_->wait_for_end();
      process_.reset();
      map_ = std::move(closing.map);
      for (auto& [module, counts] : closing.counts) {
        counts.dropped.merge(counts_[module].dropped);
        counts_[module] = std::move(counts);
      }
    });
  }

  static std::string greeting() {
    std::string line = greeting_line(false);
    line.pop_back();
    return line;
  }
  static std::string unexpected(const std::string& line, const std::string& expected) {
    return "wrote '" + line.substr(0, 60) + "', expected " + expected;
  }

  std::string name_;
  std::unique_ptr<OutsideProcess> process_;  ///< nothing once the talk has ended
  std::string header_;                       ///< until it is sent
  bool acknowledges_ = false;
  std::int64_t newest_ns_ = std::numeric_limits<std::int64_t>::min();
  OdometryLines lines_;
  std::vector<Odometry> outputs_;
  std::map<Module, MessageCounts> counts_;
  std::vector<MapPoint> map_;
};

class OutsideEstimator final : public Estimator {
 public:
  OutsideEstimator(const OutsideCommand& command, const Calibration& calibration)
      : talk_(std::make_unique<Conversation>(command, calibration)) {}

  void add(const ImuSample& sample) override { talk_->tell(Module::kImu, sample, sample.stamp_ns); }
  void add(const CameraFrame& frame) override { talk_->tell(Module::kVision, frame, frame.stamp_ns); }
  void add(const DepthFrame& frame) override { talk_->tell(Module::kVision, frame, frame.stamp_ns); }
  void add(const LidarScan& scan) override { talk_->tell(Module::kLidar, scan, scan.end_ns); }
  std::vector<Odometry> take() override { return talk_->take(); }
  // What it says of these it says last: asking ends the talk.
  MessageCounts counts(Module module) const override { return talk_->counts(module); }
  std::vector<MapPoint> map() const override { return talk_->map(); }

 private:
  std::unique_ptr<Conversation> talk_;
};

}  // namespace

std::unique_ptr<Estimator> make_outside_estimator(const OutsideCommand& command, const Calibration& calibration) {
  return std::make_unique<OutsideEstimator>(command, calibration);
}

}  // namespace plumbline
