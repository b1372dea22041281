/// Our registers over real sockets: what is answered, and that no client stands in another's way.
#include "adapters/modbus/register_server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <numeric>
#include <vector>

#include "adapters/modbus/request_frame.hpp"

namespace recald::modbus::register_server_test {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;
using Kind = CutRequest::Kind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kRegisters = 300;

/// Register a holds 1000 + a.
Words counted() {
  Words words(kRegisters);
  std::iota(words.begin(), words.end(), 1000);
  return words;
}

/// Transaction 0x0102; header and PDU.
Bytes request(std::uint8_t unit, const Bytes& pdu) {
  Bytes frame{1, 2, 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), unit};
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  return frame;
}

Bytes read_of(std::uint8_t function, int address, int count) {
  const auto high = [](int word) { return static_cast<std::uint8_t>(word >> 8); };
  const auto low = [](int word) { return static_cast<std::uint8_t>(word & 0xFF); };
  return {function, high(address), low(address), high(count), low(count)};
}

/// One end of a connection, closed with it.
class Peer {
 public:
  explicit Peer(std::uint16_t port, const char* address = "127.0.0.1")
      : socket_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    ::inet_pton(AF_INET, address, &to.sin_addr);
    is_connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }
  Peer(Peer&& other) noexcept
      : socket_{std::exchange(other.socket_, -1)}, is_connected_{other.is_connected_} {}
  ~Peer() {
    if (socket_ >= 0) ::close(socket_);
  }

  [[nodiscard]] bool is_connected() const { return is_connected_; }
  void send(const Bytes& bytes) const {
    (void)::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  /// The next bytes; none: the other end closed. Waits ten seconds at most.
  [[nodiscard]] Bytes receive() const {
    Bytes bytes(1024);
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, 10'000) <= 0) {
      ADD_FAILURE() << "nothing came";
      return {};
    }
    const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return bytes;
  }
  [[nodiscard]] Bytes ask(const Bytes& bytes) const {
    send(bytes);
    return receive();
  }

 private:
  int socket_;
  bool is_connected_;
};

class Registers : public ::testing::Test {
 protected:
  void listen(RegisterServerOptions options = {}) {
    options.port = 0;
    auto server = RegisterServer::listen(options, counted());
    ASSERT_TRUE(server.has_value()) << server.error().message;
    server_ = std::move(*server);
  }
  [[nodiscard]] Peer peer() const { return Peer{server_->port()}; }

  std::unique_ptr<RegisterServer> server_;
};

const Bytes kAsk = request(1, read_of(4, 2, 1));
const Bytes kAnswer{1, 2, 0, 0, 0, 5, 1, 4, 2, 0x03, 0xEA};

TEST_F(Registers, AreReadWithBothFunctionsAtAnyUnit) {
  listen();
  const Peer client = peer();
  for (const std::uint8_t function : Bytes{3, 4}) {
    for (const std::uint8_t unit : Bytes{0, 1, 247, 255}) {
      EXPECT_THAT(client.ask(request(unit, read_of(function, 298, 2))),
                  ElementsAre(1, 2, 0, 0, 0, 7, unit, function, 4, 0x05, 0x12, 0x05, 0x13));
    }
  }
  EXPECT_EQ(client.ask(request(1, read_of(4, 0, 125))).size(), 9u + 250u);
  EXPECT_EQ(server_->counts().reads, 9u);
}

TEST_F(Registers, ThatAreNotThereAreExceptionTwo) {
  listen();
  const Peer client = peer();
  for (const auto& [address, count] : {std::pair{299, 2}, {300, 1}, {65'535, 1}, {65'535, 125}}) {
    EXPECT_THAT(client.ask(request(1, read_of(4, address, count))),
                ElementsAre(1, 2, 0, 0, 0, 3, 1, 0x84, 2));
  }
  for (const int count : {0, 126, 65'535}) {
    EXPECT_THAT(client.ask(request(1, read_of(3, 0, count))),
                ElementsAre(1, 2, 0, 0, 0, 3, 1, 0x83, 3));
  }
}

// All writes of the protocol, as a client would send them, and whatever else it could ask for.
TEST_F(Registers, AreNeverWritten) {
  listen();
  const Peer client = peer();
  for (const Bytes& pdu :
       {Bytes{5, 0, 0, 0xFF, 0}, Bytes{6, 0, 0, 0, 7}, Bytes{15, 0, 0, 0, 1, 1, 1},
        Bytes{16, 0, 0, 0, 1, 2, 0, 7}, Bytes{22, 0, 0, 0, 0, 0, 7},
        Bytes{23, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 7}, Bytes{1, 0, 0, 0, 1}, Bytes{2, 0, 0, 0, 1},
        Bytes{7}, Bytes{8, 0, 0, 0, 0}, Bytes{17}, Bytes{43, 14, 1, 0}, Bytes{127}}) {
    EXPECT_THAT(client.ask(request(1, pdu)),
                ElementsAre(1, 2, 0, 0, 0, 3, 1, static_cast<std::uint8_t>(pdu.front() | 0x80), 1));
  }
  EXPECT_THAT(client.ask(request(1, read_of(3, 0, 2))),
              ElementsAre(1, 2, 0, 0, 0, 7, 1, 3, 4, 0x03, 0xE8, 0x03, 0xE9));
  EXPECT_EQ(server_->counts().refused, 13u);
}

TEST_F(Registers, AreReplacedAtOnce) {
  listen();
  const Peer client = peer();
  server_->set(Words(3, 7));
  EXPECT_THAT(client.ask(request(1, read_of(4, 0, 3))),
              ElementsAre(1, 2, 0, 0, 0, 9, 1, 4, 6, 0, 7, 0, 7, 0, 7));
  EXPECT_THAT(client.ask(request(1, read_of(4, 3, 1))), ElementsAre(1, 2, 0, 0, 0, 3, 1, 0x84, 2));
}

TEST_F(Registers, RequestsComeInPiecesAndSeveralAtOnce) {
  listen();
  const Peer client = peer();
  for (const std::uint8_t byte : Bytes(kAsk.begin(), kAsk.end() - 1)) client.send({byte});
  EXPECT_EQ(client.ask({kAsk.back()}), kAnswer);
  Bytes three;
  for (int i = 0; i < 3; ++i) three.insert(three.end(), kAsk.begin(), kAsk.end());
  client.send(three);
  Bytes answers;
  while (answers.size() < 3 * kAnswer.size()) {
    const Bytes more = client.receive();
    ASSERT_FALSE(more.empty());
    answers.insert(answers.end(), more.begin(), more.end());
  }
  EXPECT_EQ(Bytes(answers.end() - static_cast<std::ptrdiff_t>(kAnswer.size()), answers.end()),
            kAnswer);
}

TEST_F(Registers, HalfAFrameDelaysNobody) {
  listen();
  std::vector<Peer> slow;
  for (std::size_t bytes = 0; bytes < kAsk.size(); ++bytes) {
    slow.push_back(peer());
    slow.back().send(Bytes(kAsk.begin(), kAsk.begin() + static_cast<std::ptrdiff_t>(bytes)));
  }
  const Peer client = peer();
  EXPECT_EQ(client.ask(kAsk), kAnswer);
  for (std::size_t bytes = 0; bytes < kAsk.size(); ++bytes) {
    EXPECT_EQ(slow[bytes].ask(Bytes(kAsk.begin() + static_cast<std::ptrdiff_t>(bytes), kAsk.end())),
              kAnswer);
  }
}

TEST_F(Registers, WhatIsNoModbusEndsItsConnectionAlone) {
  listen();
  const Peer client = peer();
  EXPECT_EQ(client.ask(kAsk), kAnswer);
  const Bytes other_protocol{1, 2, 0, 1, 0, 6, 1, 4, 0, 0, 0, 1};
  const Bytes too_long{1, 2, 0, 0, 1, 0, 1, 4, 0, 0, 0, 1};
  const Bytes too_short{1, 2, 0, 0, 0, 1, 1, 4};
  const Bytes function_0 = request(1, read_of(0, 0, 1));
  const Bytes function_131 = request(1, read_of(131, 0, 1));
  const std::string web = "GET / HTTP/1.1\r\nHost: x\r\n\r\n";
  for (const Bytes& garbage : {other_protocol, too_long, too_short, function_0, function_131,
                               Bytes(web.begin(), web.end())}) {
    EXPECT_THAT(peer().ask(garbage), ElementsAre());
  }
  EXPECT_EQ(client.ask(kAsk), kAnswer);
  EXPECT_EQ(server_->counts().dropped, 6u);
}

// As many as it likes: a client that has asked for something keeps its place.
TEST_F(Registers, AFloodOfConnectionsIsBounded) {
  listen({.connections_max = 4});
  const Peer client = peer();
  EXPECT_EQ(client.ask(kAsk), kAnswer);
  std::vector<Peer> flood;
  for (int i = 0; i < 50; ++i) {
    flood.push_back(peer());
    ASSERT_TRUE(flood.back().is_connected());
  }
  // One after the other, so that the last has come before the first is asked.
  const Peer last = peer();
  EXPECT_EQ(last.ask(kAsk), kAnswer);
  EXPECT_EQ(client.ask(kAsk), kAnswer);
  int open = 0;
  for (const Peer& one : flood) open += one.ask(kAsk) == kAnswer ? 1 : 0;
  EXPECT_EQ(open, 2);
  EXPECT_EQ(server_->counts().connections, 52u);
}

TEST_F(Registers, AmongThoseThatAskedTheOneIdleForLongestMakesRoom) {
  listen({.connections_max = 2});
  const Peer first = peer();
  EXPECT_EQ(first.ask(kAsk), kAnswer);
  const Peer second = peer();
  EXPECT_EQ(second.ask(kAsk), kAnswer);
  EXPECT_EQ(first.ask(kAsk), kAnswer);
  const Peer third = peer();
  EXPECT_EQ(third.ask(kAsk), kAnswer);
  EXPECT_THAT(second.receive(), ElementsAre());
  EXPECT_EQ(first.ask(kAsk), kAnswer);
}

TEST_F(Registers, AConnectionWithoutRequestsIsClosed) {
  listen({.idle_max = 50ms});
  const Peer silent = peer();
  const Peer dripping = peer();
  dripping.send({1, 2, 0});
  EXPECT_THAT(silent.receive(), ElementsAre());
  EXPECT_THAT(dripping.receive(), ElementsAre());
}

// One that asks and never takes the answers.
TEST_F(Registers, AnswersThatNobodyTakesEndTheConnection) {
  listen();
  const Peer greedy = peer();
  const Bytes most = request(1, read_of(4, 0, 125));
  Bytes many;
  for (int i = 0; i < 1000; ++i) many.insert(many.end(), most.begin(), most.end());
  for (int i = 0; i < 1000 && server_->counts().dropped == 0; ++i) greedy.send(many);
  EXPECT_EQ(server_->counts().dropped, 1u);
  EXPECT_EQ(peer().ask(kAsk), kAnswer);
}

TEST_F(Registers, AreServedAtOneAddress) {
  listen({.address = "127.0.0.2"});
  EXPECT_EQ(Peer(server_->port(), "127.0.0.2").ask(kAsk), kAnswer);
  EXPECT_FALSE(Peer(server_->port(), "127.0.0.1").is_connected());
  EXPECT_FALSE(Peer(server_->port(), "127.0.0.3").is_connected());
}

TEST_F(Registers, AnAddressThatCannotBeHadIsSaid) {
  listen();
  const auto what = [](const std::string& address, std::uint16_t port) {
    const auto server = RegisterServer::listen({.address = address, .port = port}, counted());
    return server ? "it listens" : server.error().message;
  };
  EXPECT_THAT(what("127.0.0.1", server_->port()), HasSubstr(": Address already in use"));
  EXPECT_THAT(what("192.0.2.1", 0),
              HasSubstr("served at 192.0.2.1:0: Cannot assign requested address"));
  EXPECT_THAT(what("plant-room", 0), HasSubstr("this is no IP address"));
}

TEST(RequestFrame, IsCutWhereItsHeaderSays) {
  for (std::size_t size = 0; size < kAsk.size(); ++size) {
    EXPECT_EQ(cut_request(std::span{kAsk}.first(size)).kind, Kind::incomplete) << size;
  }
  Bytes two = kAsk;
  two.push_back(9);
  EXPECT_EQ(cut_request(two).kind, Kind::whole);
  EXPECT_EQ(cut_request(two).size, 12u);
}

// A read of another length is no read.
TEST(RequestFrame, ALengthThatIsNotTheFunctionsIsRefused) {
  Bytes pdu = read_of(4, 0, 1);
  pdu.push_back(0);
  EXPECT_EQ(check_request(request(1, pdu), kRegisters), RequestVerdict::illegal_value);
  EXPECT_EQ(check_request(request(1, {4}), kRegisters), RequestVerdict::illegal_value);
}

}  // namespace
}  // namespace recald::modbus::register_server_test
