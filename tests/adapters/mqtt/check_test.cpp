// What cannot be a connection or a message is said before anything is sent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/adapters/mqtt/connected.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::mqtt {
namespace {

using ::testing::HasSubstr;

std::string fault_of(const Broker& broker, const Session& session) {
  const auto opened = Connection::open(
      broker, session, [](const Message&) {}, [](bool, const std::string&) {});
  return opened ? "none" : opened.error().message;
}

TEST(MqttCheck, SaysWhatIsWrongWithABroker) {
  Broker broker = loopback(1883);
  EXPECT_EQ(fault_of(broker, {}), "none");

  broker.port = 0;
  EXPECT_EQ(fault_of(broker, {}), "'127.0.0.1:0' is no broker: it needs a host and a port");
  broker = loopback(1883, "");
  EXPECT_THAT(fault_of(broker, {}), HasSubstr("client id"));
  broker = loopback(1883);
  broker.certificate_file = "client.pem";
  EXPECT_THAT(fault_of(broker, {}), HasSubstr("certificate and key belong together"));
}

TEST(MqttCheck, SaysWhichTopicCannotBe) {
  const Broker broker = loopback(1883);
  EXPECT_THAT(fault_of(broker, {.will = Message{.topic = "a/#"}}), HasSubstr("'a/#'"));
  EXPECT_THAT(fault_of(broker, {.birth = Message{.topic = ""}}), HasSubstr("''"));
  EXPECT_THAT(fault_of(broker, {.topics = {"a/b#"}}), HasSubstr("'a/b#'"));
  EXPECT_EQ(fault_of(broker, {.will = Message{.topic = "a"}, .topics = {"a/+/c", "#"}}), "none");
}

TEST(MqttCheck, SaysWhichFileCannotBeUsed) {
  const testing::TemporaryFolder folder;
  Broker broker = loopback(8883);
  broker.is_tls = true;
  EXPECT_EQ(fault_of(broker, {}), "none");

  broker.trusted_certificate = folder / "missing.pem";
  EXPECT_EQ(fault_of(broker, {}), "the trusted certificate " + (folder / "missing.pem").string() +
                                      " cannot be used: No such file or directory");
  testing::write_text(folder / "text.pem", "no certificate\n");
  broker.trusted_certificate = folder / "text.pem";
  EXPECT_THAT(fault_of(broker, {}), HasSubstr("text.pem cannot be used"));
}

TEST(MqttCheck, RefusesAMessageToNoTopic) {
  Connected connection{loopback(1)};
  for (const std::string& topic :
       {std::string{}, std::string{"a/+"}, std::string{"a\0b", 3}, std::string{"\xff"}}) {
    const auto done = connection.publish({{.topic = topic, .payload = "1"}});
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().code, ErrorCode::invalid_value);
  }
}

}  // namespace
}  // namespace recald::mqtt
