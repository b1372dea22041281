// A broker that is gone or does not answer: that is told, and nobody waits for it for long.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <future>

#include "tests/adapters/mqtt/connected.hpp"
#include "tests/support/mosquitto.hpp"

namespace recald::mqtt {
namespace {

using testing::eventually;

/// A socket that listens, and nobody who accepts.
class Listener {
 public:
  explicit Listener(int backlog) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::bind(socket_, reinterpret_cast<::sockaddr*>(&address_), size_);
    ::getsockname(socket_, reinterpret_cast<::sockaddr*>(&address_), &size_);
    ::listen(socket_, backlog);
  }
  ~Listener() { ::close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  [[nodiscard]] std::uint16_t port() const { return ntohs(address_.sin_port); }
  /// Connects without waiting.
  [[nodiscard]] int call() const {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    ::connect(socket, reinterpret_cast<const ::sockaddr*>(&address_), size_);
    return socket;
  }
  /// How many wait for the answer to their call, as the kernel says.
  [[nodiscard]] std::size_t unanswered() const {
    const std::string calls = testing::read_text("/proc/net/tcp");
    return testing::count_of(fmt::format(":{:04X} 02 ", port()), calls);
  }
  [[nodiscard]] int accept() const { return ::accept(socket_, nullptr, nullptr); }

 private:
  int socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
  ::sockaddr_in address_{};
  ::socklen_t size_ = sizeof address_;
};

/// Whether the destructor returns in half a minute, while nobody answers.
bool closes_soon(Connected& connection) {
  std::promise<void> closed;
  std::thread closer{[&] {
    connection.close();
    closed.set_value();
  }};
  const bool is_soon = closed.get_future().wait_for(kPatience) == std::future_status::ready;
  closer.join();
  return is_soon;
}

TEST(MqttSilentBroker, NobodyThereIsToldAndTriedAgain) {
  std::uint16_t port = 0;
  {
    const Listener gone{1};
    port = gone.port();
  }
  Connected connection{loopback(port)};
  ASSERT_TRUE(connection.is_soon_told("127.0.0.1:" + std::to_string(port) +
                                      " cannot be reached: Connection refused"));
  EXPECT_FALSE(connection->is_connected());
  EXPECT_TRUE(closes_soon(connection));
}

TEST(MqttSilentBroker, AHostWithoutAnAddressIsTold) {
  Broker broker = loopback(1883);
  broker.host = "broker.invalid";
  const Connected connection{broker};
  EXPECT_TRUE(connection.is_soon_told("broker.invalid:1883 cannot be reached: "));
}

TEST(MqttSilentBroker, OneThatNeverAnswersIsTold) {
  const Listener listener{8};
  Connected connection{loopback(listener.port())};
  EXPECT_TRUE(connection.is_soon_told("did not answer within 10 s"));
  EXPECT_TRUE(closes_soon(connection));
}

TEST(MqttSilentBroker, OneThatIsNoBrokerIsTold) {
  const Listener listener{8};
  const Connected connection{loopback(listener.port())};
  const int caller = listener.accept();
  const std::string answer = "HTTP/1.1 400 Bad Request\r\n\r\n" + std::string(100, '.');
  ASSERT_EQ(::write(caller, answer.data(), answer.size()), static_cast<ssize_t>(answer.size()));
  EXPECT_TRUE(connection.is_soon_told("the connection is lost"));
  ::close(caller);
}

// Debian's broker only closes the socket where others give this reason.
TEST(MqttSilentBroker, ItsLastWordIsTold) {
  const Listener listener{8};
  const Connected connection{loopback(listener.port())};
  const int caller = listener.accept();
  constexpr std::array<unsigned char, 8> kPackets{0x20, 3, 0, 0, 0, 0xE0, 1, 142};
  ASSERT_EQ(::write(caller, kPackets.data(), kPackets.size()), 8);
  EXPECT_TRUE(connection.is_soon_told("ended the connection: Session taken over"));
  EXPECT_EQ(connection.states().size(), 2U);
  ::close(caller);
}

TEST(MqttSilentBroker, ATlsConnectionThatIsResetIsTold) {
  const Listener listener{8};
  Broker broker = loopback(listener.port());
  broker.is_tls = true;
  const Connected connection{broker};
  const int caller = listener.accept();
  std::array<char, 1> hello{};
  ASSERT_EQ(::read(caller, hello.data(), 1), 1);
  constexpr ::linger kReset{1, 0};
  ::setsockopt(caller, SOL_SOCKET, SO_LINGER, &kReset, sizeof kReset);
  ::close(caller);
  EXPECT_TRUE(connection.is_soon_told("the connection is lost: the broker closed it"));
}

// The kernel answers no more once its queue is full: connect() then takes minutes.
TEST(MqttSilentBroker, OneThatCannotBeConnectedToKeepsNobodyFromLeaving) {
  const Listener listener{0};
  const std::array<int, 3> callers{listener.call(), listener.call(), listener.call()};
  const std::size_t unanswered = listener.unanswered();
  Connected connection{loopback(listener.port())};
  ASSERT_TRUE(eventually([&] { return listener.unanswered() > unanswered; }));
  EXPECT_TRUE(closes_soon(connection));
  EXPECT_GT(listener.unanswered(), unanswered);
  EXPECT_TRUE(connection.states().empty());
  for (const int caller : callers) ::close(caller);
}

TEST(MqttSilentBroker, OneThatStopsAnsweringKeepsNobodyFromLeaving) {
  if (!testing::Mosquitto::can_run())
    GTEST_SKIP() << "no mosquitto: apt-get install mosquitto mosquitto-clients";
  testing::Mosquitto broker;
  broker.start();
  Connected connection{loopback(broker.port())};
  ASSERT_TRUE(connection.is_soon_connected());
  broker.freeze();
  EXPECT_FALSE(connection
                   ->publish(std::vector<Message>(50, Message{"a", std::string(100'000, 'x')}),
                             std::chrono::milliseconds{100}, {})
                   .has_value());
  EXPECT_TRUE(closes_soon(connection));
}

}  // namespace
}  // namespace recald::mqtt
