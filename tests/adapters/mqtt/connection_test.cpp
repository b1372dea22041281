// Against a real broker, read by its own programs.
#include "adapters/mqtt/connection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <thread>

#include "tests/adapters/mqtt/connected.hpp"
#include "tests/support/mosquitto.hpp"

namespace recald::mqtt {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;
using testing::eventually;
using ::testing::HasSubstr;
using testing::Mosquitto;
using ::testing::Not;

class MqttConnection : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Mosquitto::can_run())
      GTEST_SKIP() << "no mosquitto: apt-get install mosquitto mosquitto-clients";
  }
};

/// Runs it in a process of its own, which stays until it is killed.
template <class Body>
pid_t in_a_process(const Body& body) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  body();
  for (;;) ::pause();
}
int end_of(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

TEST_F(MqttConnection, PublishesWhatAnotherProgramReads) {
  Mosquitto broker;
  broker.start();
  const auto reader = broker.reader("site/#");
  const Connected connection{loopback(broker.port())};
  ASSERT_TRUE(connection.is_soon_connected());
  const std::vector<Message> messages{
      {.topic = "site/a", .payload = "1"},
      {.topic = "site/kept", .payload = "grün", .is_retained = true},
      {.topic = "site/empty", .payload = ""}};

  const auto done = connection.publish(messages);

  ASSERT_TRUE(done.has_value()) << done.error().message;
  ASSERT_TRUE(eventually([&] { return reader->count() == 3; }));
  // What is sent to who has subscribed already does not say that it is kept.
  EXPECT_EQ(reader->messages()[0], messages[0]);
  EXPECT_EQ(reader->messages()[1].payload, "grün");
  EXPECT_FALSE(reader->messages()[1].is_retained);
  EXPECT_EQ(reader->messages()[2], messages[2]);
  EXPECT_THAT(broker.read("site/#", 1, seconds{10}), ElementsAre(messages[1]));
  EXPECT_THAT(broker.log(), HasSubstr("as recald (p5, c0, k30)"));  // MQTT 5, its session is kept
}

TEST_F(MqttConnection, SaysGoodbyeSoThatNoWillIsSent) {
  Mosquitto broker;
  broker.start();
  const auto reader = broker.reader("#");
  Connected connection{loopback(broker.port()),
                       {.will = Message{"state", "lost"}, .birth = Message{"state", "here"}}};
  ASSERT_TRUE(eventually([&] { return reader->count() == 1; }));
  EXPECT_THAT(reader->messages(), ElementsAre(Message{"state", "here"}));

  connection.close();

  broker.send({"marker", "after"});
  ASSERT_TRUE(eventually([&] { return reader->count() == 2; }));
  EXPECT_EQ(reader->messages()[1].topic, "marker");
  EXPECT_THAT(broker.log(), HasSubstr("Received DISCONNECT from recald"));
}

TEST_F(MqttConnection, AKilledProcessIsMissed) {
  Mosquitto broker;
  broker.start();
  const auto reader = broker.reader("#");
  const pid_t child = in_a_process([&] {
    static Connected connection{
        loopback(broker.port()),
        {.will = Message{"state", "lost", true}, .birth = Message{"state", "here", true}}};
  });
  ASSERT_TRUE(eventually([&] { return reader->count() == 1; }));
  EXPECT_EQ(reader->messages()[0].payload, "here");

  ::kill(child, SIGKILL);
  end_of(child);

  ASSERT_TRUE(eventually([&] { return reader->count() == 2; }));
  EXPECT_EQ(reader->messages()[1].payload, "lost");
  EXPECT_THAT(broker.read("state", 1, seconds{10}), ElementsAre(Message{"state", "lost", true}));
}

TEST_F(MqttConnection, NamesRefusedCredentialsAndGetsInOnceTheyAreRight) {
  Mosquitto broker;
  broker.set_password("recald", "another");
  broker.start();
  Broker login = loopback(broker.port());
  login.user = "recald";
  login.password = "sesame-open";
  const Connected connection{login};
  ASSERT_TRUE(
      connection.is_soon_told("refused the connection: Not authorized; check user and password"));

  const auto done = connection.publish({{"a", "1"}});

  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().code, ErrorCode::io_failed);
  const std::string name = "127.0.0.1:" + std::to_string(broker.port());
  EXPECT_EQ(done.error().message,
            name + " is not connected: " + name +
                " refused the connection: Not authorized; check user and password");
  // Once per cause: not at the second refusal either.
  ASSERT_TRUE(eventually([&] {
    return testing::count_of("Sending CONNACK to 127.0.0.1 (0, 135)", broker.log()) > 1;
  }));
  EXPECT_EQ(connection.states().size(), 1U);
  EXPECT_EQ(connection.told("sesame"), 0);

  broker.set_password("recald", "sesame-open");
  broker.reload();

  ASSERT_TRUE(connection.is_soon_connected());
  EXPECT_TRUE(connection.publish({{"a", "1"}}).has_value());
  ASSERT_EQ(connection.states().size(), 2U);
  EXPECT_TRUE(connection.states()[1].is_connected);
}

TEST_F(MqttConnection, AMessageThatTheBrokerRefusesIsAFailure) {
  Mosquitto broker{{.acl = "user recald\ntopic readwrite open/#\n"}};
  broker.set_password("recald", "open");
  broker.start();
  Broker login = loopback(broker.port());
  login.user = "recald";
  login.password = "open";
  const Connected connection{login, {.birth = Message{"closed/birth", "1"}}};
  ASSERT_TRUE(connection.is_soon_connected());

  const auto refused = connection.publish({{"open/a", "1"}, {"closed/b", "2"}, {"open/c", "3"}});
  const auto taken = connection.publish({{"open/a", "1"}});

  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
  EXPECT_THAT(refused.error().message,
              HasSubstr(" refused the message on closed/b: Not authorized"));
  EXPECT_TRUE(taken.has_value()) << taken.error().message;
  EXPECT_TRUE(connection.is_soon_told("refused the message on closed/birth: Not authorized"));
  EXPECT_TRUE(connection->is_connected());
}

TEST_F(MqttConnection, ARefusedSubscriptionIsTold) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "rights.json",
                      R"({"defaultACLAccess": {"publishClientSend": true, "subscribe": false}})");
  std::string plugin = "/usr/lib/x86_64-linux-gnu/mosquitto_dynamic_security.so";
  if (!std::filesystem::exists(plugin))
    plugin = "/usr/lib/aarch64-linux-gnu/mosquitto_dynamic_security.so";
  Mosquitto broker{{.more = "plugin " + plugin + "\nplugin_opt_config_file " +
                            (folder / "rights.json").string()}};
  broker.start();

  const Connected connection{loopback(broker.port()), {.topics = {"in/#"}}};

  EXPECT_TRUE(connection.is_soon_told("refused the subscription to in/#: Not authorized"));
  EXPECT_TRUE(connection->is_connected());
}

TEST_F(MqttConnection, KeepsToWhatTheBrokerTakes) {
  Mosquitto broker{{.more = "max_packet_size 2000\nmax_inflight_messages 3\n"}};
  broker.start();
  const auto reader = broker.reader("#");
  const Connected connection{loopback(broker.port())};
  ASSERT_TRUE(connection.is_soon_connected());
  // 1 of the header, 2 of the length, 2 + 4 of the topic, 2 of the identifier, 1 of the properties.
  const std::string longest(2000 - 12, 'x');

  const auto too_long = connection.publish({{"long", longest + "x"}});
  const auto taken = connection.publish({{"long", longest}});
  const auto many = connection.publish(std::vector<Message>(1000, Message{"many", "1"}));

  ASSERT_FALSE(too_long.has_value());
  EXPECT_EQ(too_long.error().code, ErrorCode::out_of_range);
  EXPECT_THAT(too_long.error().message, HasSubstr("a message on long is too long"));
  EXPECT_THAT(too_long.error().message, HasSubstr("2001 bytes, it takes 2000"));
  EXPECT_TRUE(taken.has_value()) << taken.error().message;
  EXPECT_TRUE(many.has_value()) << many.error().message;
  EXPECT_TRUE(eventually([&] { return reader->count() == 1001; }));
}

TEST_F(MqttConnection, WaitsNoLongerThanAskedAndStopsWhenAsked) {
  Mosquitto broker;
  broker.start();
  const Connected connection{loopback(broker.port())};
  ASSERT_TRUE(connection.is_soon_connected());
  broker.freeze();
  std::stop_source stop;

  const auto late =
      connection->publish(std::vector<Message>{{"a", "1"}}, std::chrono::milliseconds{50}, {});
  std::jthread stopper{[&] { stop.request_stop(); }};
  const auto stopped =
      connection->publish(std::vector<Message>{{"b", "2"}}, kPatience, stop.get_token());
  broker.thaw();

  ASSERT_FALSE(late.has_value());
  EXPECT_EQ(late.error().code, ErrorCode::io_failed);
  EXPECT_THAT(late.error().message, HasSubstr("acknowledged 0 of 1 messages within 0.05 s"));
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  // What is acknowledged late counts for nobody.
  EXPECT_TRUE(connection.publish({{"c", "3"}, {"d", "4"}}).has_value());
}

}  // namespace
}  // namespace recald::mqtt
