#include "tools/outside/library_host.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "estimator/estimator.h"
#include "scenarios/input_error.h"
#include "tools/formats/message_stream.h"
#include "tools/outside/odometry_lines.h"

namespace plumbline {
namespace {

using MakeEstimator = Estimator*(const char* calibration_yaml);

/// The library stays loaded: the estimator's code is in it.
MakeEstimator* maker_in(const std::filesystem::path& library) {
  void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* symbol = handle != nullptr ? dlsym(handle, kMakeEstimatorSymbol) : nullptr;
  if (symbol == nullptr) {
    const char* reason = dlerror();
    throw InputError(library.string() + ": no estimator library: " + (reason != nullptr ? reason : "no reason given"));
  }
  return reinterpret_cast<MakeEstimator*>(symbol);
}

/// Standard output as it was, for answers alone; from now on what is printed goes to standard error.
class Answers {
 public:
  Answers() : file_(dup(STDOUT_FILENO)) { dup2(STDERR_FILENO, STDOUT_FILENO); }
  ~Answers() { close(file_); }
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;

  void write_all(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t size = ::write(file_, text.data(), text.size());
      if (size < 0 && errno == EINTR) continue;
      if (size < 0) throw std::runtime_error(std::string("the answers cannot be written: ") + std::strerror(errno));
      text.remove_prefix(static_cast<std::size_t>(size));
    }
  }

 private:
  int file_;
};

std::string answer_to(Estimator& estimator, const SensorPayload& message) {
  std::visit([&](const auto& payload) { estimator.add(payload); }, message);
  if (!std::holds_alternative<ImuSample>(message)) return std::string(kDone) + '\n';
  const std::vector<Odometry> outputs = estimator.take();
  if (outputs.empty()) return std::string(kNoPose) + '\n';
  std::string text;
  for (const Odometry& output : outputs) text += odometry_lines(output);
  return text;
}

std::string closing_lines(const Estimator& estimator) {
  std::string text;
  for (const Module module : {Module::kImu, Module::kVision, Module::kLidar}) {
    text += counts_lines(module, estimator.counts(module));
  }
  for (const MapPoint& point : estimator.map()) text += point_line(point);
  return text;
}

}  // namespace

void host_library(const std::filesystem::path& library) {
  const Answers answers;
  MakeEstimator* make_estimator = maker_in(library);
  std::ios::sync_with_stdio(false);
  MessageStreamReader messages(std::cin, "standard input");
  const std::unique_ptr<Estimator> estimator(make_estimator(messages.calibration_text().c_str()));
  if (estimator == nullptr) throw std::runtime_error(library.string() + ": made no estimator");
  answers.write_all(greeting_line(/*acknowledge=*/true));
  while (const auto message = messages.read()) answers.write_all(answer_to(*estimator, message->payload));
  answers.write_all(closing_lines(*estimator));
}

}  // namespace plumbline
