#include "daemon/gateway/forward/waiting_messages.hpp"

#include <gtest/gtest.h>

#include <map>

namespace recald::daemon {
namespace {

TEST(WaitingMessages, ComeOutInOrderAndSayWhenTheFirstCame) {
  WaitingMessages waiting;
  EXPECT_TRUE(waiting.add({.topic = "a", .payload = "1"}));
  EXPECT_FALSE(waiting.add({.topic = "b", .payload = "2"}));
  EXPECT_FALSE(waiting.add({.topic = "a", .payload = "3"}));
  std::string order;
  for (const mqtt::Message& message : waiting.take()) order += message.topic + message.payload;
  EXPECT_EQ(order, "a1b2a3");
  EXPECT_TRUE(waiting.take().empty());
  EXPECT_TRUE(waiting.add({.topic = "a", .payload = "4"}));
  EXPECT_EQ(waiting.dropped(), 0);
}

// 26 000 a second of one topic, while the loop is elsewhere.
TEST(WaitingMessages, BeyondTheLimitTheNewestOfEachTopicStay) {
  constexpr std::size_t kLimit = 100'000;
  WaitingMessages waiting{kLimit};
  (void)waiting.add({.topic = "quiet", .payload = "first"});
  for (int i = 0; i < 10'000; ++i) {
    (void)waiting.add({.topic = "loud/" + std::to_string(i % 3),
                       .payload = std::string(1'000, 'x') + std::to_string(i)});
  }
  std::map<std::string, std::string> newest;
  std::size_t bytes = 0;
  std::size_t count = 0;
  for (const mqtt::Message& message : waiting.take()) {
    newest[message.topic] = message.payload;
    bytes += message.topic.size() + message.payload.size();
    ++count;
  }
  EXPECT_LE(bytes, kLimit);
  EXPECT_GT(bytes, kLimit / 2);
  EXPECT_EQ(newest["quiet"], "first");
  for (const int last : {9'997, 9'998, 9'999}) {
    EXPECT_TRUE(newest["loud/" + std::to_string(last % 3)].ends_with(std::to_string(last)));
  }
  EXPECT_EQ(waiting.dropped(), 10'001 - static_cast<std::int64_t>(count));
}

TEST(WaitingMessages, OneThatIsLongerThanAllMayBeIsStillRead) {
  WaitingMessages waiting{1'000};
  (void)waiting.add({.topic = "a", .payload = "1"});
  (void)waiting.add({.topic = "b", .payload = std::string(5'000, 'x')});
  EXPECT_EQ(waiting.take().size(), 1U);
}

}  // namespace
}  // namespace recald::daemon
