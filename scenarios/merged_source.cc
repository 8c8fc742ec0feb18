#include "scenarios/merged_source.h"

#include <memory>
#include <utility>

namespace plumbline {
namespace {

class MergedSource {
 public:
  MergedSource(MessageSource first, MessageSource second)
      : first_(std::move(first)), second_(std::move(second)), next_first_(first_()), next_second_(second_()) {}

  std::unique_ptr<SensorMessage> next() {
    const bool take_first = next_first_ && (!next_second_ || next_first_->delivery_ns <= next_second_->delivery_ns);
    return take_first ? std::exchange(next_first_, first_())
                      : std::exchange(next_second_, next_second_ ? second_() : nullptr);
  }

 private:
  MessageSource first_;
  MessageSource second_;
  std::unique_ptr<SensorMessage> next_first_;
  std::unique_ptr<SensorMessage> next_second_;
};

}  // namespace

MessageSource merged_sources(MessageSource first, MessageSource second) {
  return [source = std::make_shared<MergedSource>(std::move(first), std::move(second))] { return source->next(); };
}

}  // namespace plumbline
