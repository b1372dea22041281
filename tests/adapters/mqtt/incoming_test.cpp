// What others send us.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/adapters/mqtt/connected.hpp"
#include "tests/support/mosquitto.hpp"

namespace recald::mqtt {
namespace {

using ::testing::ElementsAre;
using testing::eventually;
using testing::Mosquitto;
using ::testing::SizeIs;

class MqttIncoming : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Mosquitto::can_run())
      GTEST_SKIP() << "no mosquitto: apt-get install mosquitto mosquitto-clients";
    broker_.start();
  }
  Connected connect() { return Connected{loopback(broker_.port()), {.topics = {"in/+", "other"}}}; }

  Mosquitto broker_{{.is_persistent = true}};
};

TEST_F(MqttIncoming, ArrivesWithItsTopicAndWhetherItWasKept) {
  broker_.send({"in/kept", "old", true});
  const Connected connection = connect();
  ASSERT_TRUE(eventually([&] { return connection.messages().size() == 1; }));

  broker_.send({"in/kept", "new", true});
  broker_.send({"other", std::string{"\0\xff", 2}});
  broker_.send({"another", "not asked for"});
  broker_.send({"in/empty", ""});

  ASSERT_TRUE(eventually([&] { return connection.messages().size() == 4; }));
  EXPECT_THAT(connection.messages(),
              ElementsAre(Message{"in/kept", "old", true}, Message{"in/kept", "new", false},
                          Message{"other", std::string{"\0\xff", 2}}, Message{"in/empty", ""}));
}

TEST_F(MqttIncoming, WhatWasSentWhileWeWereAwayIsKeptForUs) {
  Connected connection = connect();
  ASSERT_TRUE(eventually([&] { return broker_.subscriptions("recald") == 1; }));
  connection.close();
  broker_.send({"in/a", "1"});
  broker_.send({"in/a", "2"});
  broker_.stop();  // the broker's own restart does not lose it either
  broker_.start();

  const Connected again = connect();

  ASSERT_TRUE(eventually([&] { return again.messages().size() == 2; }));
  EXPECT_THAT(again.messages(), ElementsAre(Message{"in/a", "1"}, Message{"in/a", "2"}));
}

TEST_F(MqttIncoming, SubscribesAgainAtABrokerThatForgot) {
  const Connected connection = connect();
  ASSERT_TRUE(eventually([&] { return broker_.subscriptions("recald") == 1; }));
  broker_.kill();
  ASSERT_TRUE(
      connection.is_soon_told("the connection is lost: the broker closed it without a word"));
  broker_.start();
  ASSERT_TRUE(eventually([&] { return broker_.subscriptions("recald") == 2; }));

  broker_.send({"in/a", "1"});

  EXPECT_TRUE(eventually([&] { return connection.messages().size() == 1; }));
}

// A message is acknowledged when it was handled: a process that ends meanwhile gets it again.
TEST_F(MqttIncoming, IsAcknowledgedAfterItWasHandled) {
  const pid_t child = ::fork();
  if (child == 0) {
    const auto connection = Connection::open(
        loopback(broker_.port()), {.topics = {"in/+"}},
        [](const Message&) {
          // Long enough for an acknowledgement on its way.
          std::this_thread::sleep_for(std::chrono::milliseconds{200});
          ::raise(SIGKILL);
        },
        [](bool, const std::string&) {});
    for (;;) ::pause();
  }
  ASSERT_TRUE(eventually([&] { return broker_.subscriptions("recald") == 1; }));
  std::jthread sender{[this] { broker_.send({"in/a", "1"}); }};
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));

  const Connected again = connect();

  ASSERT_TRUE(eventually([&] { return !again.messages().empty(); }));
  EXPECT_THAT(again.messages(), ElementsAre(Message{"in/a", "1"}));
}

TEST_F(MqttIncoming, WhatIsTooLongIsDroppedAndToldOnce) {
  const Connected connection = connect();
  ASSERT_TRUE(eventually([&] { return broker_.subscriptions("recald") == 1; }));
  const std::string longest(1 << 20, 'x');

  broker_.send({"in/a", longest + "x"});
  broker_.send({"in/a", longest + "x"});
  broker_.send({"in/a", longest});

  ASSERT_TRUE(eventually([&] { return !connection.messages().empty(); }));
  EXPECT_THAT(connection.messages(), ElementsAre(Message{"in/a", longest}));
  EXPECT_EQ(connection.told("a message on in/a was dropped: it is longer than 1 MiB"), 1);
}

}  // namespace
}  // namespace recald::mqtt
