// A broker that is killed. Its acknowledgement says that it has a message, not that its disk or a
// reader has it: so before the kill the reader has all that was acknowledged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <set>

#include "tests/adapters/mqtt/connected.hpp"
#include "tests/support/mosquitto.hpp"

namespace recald::mqtt {
namespace {

using testing::eventually;
using testing::Mosquitto;

std::vector<Message> numbered(int from, int to) {
  std::vector<Message> messages;
  for (int i = from; i < to; ++i) messages.push_back({"n/" + std::to_string(i), std::to_string(i)});
  return messages;
}

TEST(MqttLosses, WhatWasSaidToBePublishedHasArrivedWhenTheBrokerIsKilled) {
  if (!Mosquitto::can_run())
    GTEST_SKIP() << "no mosquitto: apt-get install mosquitto mosquitto-clients";
  // As many as come wait in the broker for a slow reader.
  Mosquitto broker{{.more = "max_queued_messages 0\n"}};
  broker.start();
  const auto reader = broker.reader("#");
  const Connected connection{loopback(broker.port())};
  ASSERT_TRUE(connection.is_soon_connected());
  ASSERT_TRUE(connection.publish(numbered(0, 1000)).has_value());
  ASSERT_TRUE(eventually([&] { return reader->count() == 1000; }));

  // Of the others the broker dies.
  const auto others = numbered(1000, 10'000);
  auto done = std::async(std::launch::async, [&] { return connection.publish(others); });
  while (reader->count() < 1100) std::this_thread::yield();
  broker.kill();
  const auto lost = done.get();
  ASSERT_FALSE(lost.has_value());
  EXPECT_EQ(lost.error().code, ErrorCode::io_failed);
  const std::size_t subscriptions = broker.subscriptions("reader0");
  broker.start();
  ASSERT_TRUE(connection.is_soon_connected());
  ASSERT_TRUE(eventually([&] { return broker.subscriptions("reader0") > subscriptions; }));

  // Nothing was left in the library to be sent by itself.
  const std::size_t had = reader->count();
  EXPECT_LT(had, 10'000U);
  ASSERT_TRUE(connection.publish({{"marker", ""}}).has_value());
  ASSERT_TRUE(eventually([&] { return reader->count() > had; }));
  EXPECT_EQ(reader->messages()[had].topic, "marker");

  const auto again = connection.publish(others);
  ASSERT_TRUE(again.has_value()) << again.error().message;
  const auto distinct = [&] {
    std::set<std::string> topics;
    for (const Message& message : reader->messages()) topics.insert(message.topic);
    return topics.size();
  };
  EXPECT_TRUE(eventually([&] { return distinct() == 10'001; })) << distinct();
}

}  // namespace
}  // namespace recald::mqtt
