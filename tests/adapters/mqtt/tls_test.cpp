// TLS to a real broker: whom we trust, and who trusts us.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/adapters/http/self_signed.hpp"
#include "tests/adapters/mqtt/connected.hpp"
#include "tests/support/mosquitto.hpp"

namespace recald::mqtt {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;
using testing::Mosquitto;
using testing::write_self_signed;

class MqttTls : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Mosquitto::can_run())
      GTEST_SKIP() << "no mosquitto: apt-get install mosquitto mosquitto-clients";
  }
  /// Trusts what is given.
  static Broker over_tls(const Mosquitto& broker, const std::filesystem::path& trusted) {
    Broker secured = loopback(broker.port());
    secured.host = "localhost";
    secured.is_tls = true;
    secured.trusted_certificate = trusted;
    return secured;
  }

  testing::TemporaryFolder folder_;
  http::TlsFiles files_ = write_self_signed(folder_.path(), "localhost");
};

TEST_F(MqttTls, IsMadeToABrokerThatIsTrusted) {
  Mosquitto broker{{.certificate = files_.certificate, .key = files_.key}};
  broker.start();
  const Connected connection{over_tls(broker, files_.certificate), {.topics = {"in/#"}}};
  ASSERT_TRUE(connection.is_soon_connected());
  const Message message{"a", std::string(100'000, 'x'), true};

  EXPECT_TRUE(connection.publish(std::vector<Message>(200, message)).has_value());

  EXPECT_THAT(broker.read("a", 1, seconds{10}), ElementsAre(message));
  for (int i = 0; i < 5; ++i) broker.send({"in/a", message.payload});
  EXPECT_TRUE(testing::eventually([&] { return connection.messages().size() == 5; }));
}

TEST_F(MqttTls, IsNotMadeToAnother) {
  Mosquitto broker{{.certificate = files_.certificate, .key = files_.key}};
  broker.start();
  const auto other = write_self_signed(folder_.path(), "other");
  const Connected wrong{over_tls(broker, other.certificate)};
  const Connected as_the_system{over_tls(broker, "")};

  for (const Connected* connection : {&wrong, &as_the_system}) {
    EXPECT_TRUE(connection->is_soon_told(
        "localhost:" + std::to_string(broker.port()) +
        " is not trusted: its certificate has this fault: self-signed certificate"));
    EXPECT_FALSE((*connection)->is_connected());
  }
}

TEST_F(MqttTls, IsNotMadeUnderAnotherName) {
  const auto other = write_self_signed(folder_.path(), "other");
  Mosquitto broker{{.certificate = other.certificate, .key = other.key}};
  broker.start();
  Broker by_address = over_tls(broker, other.certificate);
  by_address.host = "127.0.0.1";
  const Connected by_name{over_tls(broker, other.certificate)};
  const Connected by_number{by_address};

  EXPECT_TRUE(by_name.is_soon_told("fault: hostname mismatch"));
  EXPECT_TRUE(by_number.is_soon_told("fault: IP address mismatch"));
  EXPECT_FALSE(by_name->is_connected());
  EXPECT_FALSE(by_number->is_connected());
}

TEST_F(MqttTls, ShowsTheCertificateThatABrokerAsksFor) {
  const auto ours = write_self_signed(folder_.path(), "gateway");
  Mosquitto broker{{.certificate = files_.certificate,
                    .key = files_.key,
                    .client_certificate = ours.certificate}};
  broker.start();
  Broker shown = over_tls(broker, files_.certificate);
  shown.certificate_file = ours.certificate;
  shown.key_file = ours.key;
  Broker other = over_tls(broker, files_.certificate);
  other.client_id = "other";

  const Connected connection{shown};
  const Connected without{other};

  EXPECT_TRUE(connection.is_soon_connected());
  // "certificate required", unless the broker's reset overtakes its alert.
  EXPECT_TRUE(testing::eventually([&] { return !without.states().empty(); }));
  EXPECT_FALSE(without.states()[0].is_connected);
}

TEST_F(MqttTls, IsNotMadeToABrokerWithoutIt) {
  Mosquitto broker;
  broker.start();
  const Connected connection{over_tls(broker, files_.certificate)};
  EXPECT_TRUE(testing::eventually([&] { return !connection.states().empty(); }));
  EXPECT_FALSE(connection->is_connected());
}

TEST_F(MqttTls, AKeyOfAnotherCertificateIsSaidAtOnce) {
  const auto other = write_self_signed(folder_.path(), "other");
  Broker broker = loopback(8883);
  broker.is_tls = true;
  broker.certificate_file = files_.certificate;
  broker.key_file = other.key;
  const auto opened = Connection::open(
      broker, {}, [](const Message&) {}, [](bool, const std::string&) {});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::io_failed);
  EXPECT_THAT(opened.error().message,
              ::testing::HasSubstr("other.key cannot be used: key values mismatch"));
}

}  // namespace
}  // namespace recald::mqtt
