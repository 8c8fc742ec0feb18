#include "scenarios/bounded_queue.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <thread>

namespace plumbline {
namespace {

using Queue = BoundedQueue<std::unique_ptr<int>>;

TEST(BoundedQueue, PassesAllItemsInOrderThenNothing) {
  Queue queue(3);
  std::thread producer([&] {
    for (int i = 0; i < 1000; ++i) queue.push(std::make_unique<int>(i));
    queue.close();
  });
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(*queue.pop(), i);
  EXPECT_EQ(queue.pop(), nullptr);
  EXPECT_EQ(queue.pop(), nullptr);
  producer.join();
}

TEST(BoundedQueue, ReportsAFailureAfterTheItemsBeforeIt) {
  Queue queue(3);
  queue.push(std::make_unique<int>(1));
  queue.close(std::make_exception_ptr(std::runtime_error("no more")));
  EXPECT_EQ(*queue.pop(), 1);
  EXPECT_THROW(queue.pop(), std::runtime_error);
}

TEST(BoundedQueue, ReleasesAWaitingProducerWhenTheConsumerLeaves) {
  Queue queue(1);
  bool accepted = true;
  std::thread producer([&] {
    while (accepted) accepted = queue.push(std::make_unique<int>(0));
  });
  EXPECT_EQ(*queue.pop(), 0);
  queue.abandon();
  producer.join();
  EXPECT_FALSE(accepted);
}

}  // namespace
}  // namespace plumbline
