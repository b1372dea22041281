/// A connection against devices that answer late, in pieces, wrongly or not at all, over real
/// sockets and pseudo-terminals.
#include "adapters/modbus/connection.hpp"

#include <gmock/gmock.h>

#include <sys/resource.h>
#include <set>

#include <future>

#include "tests/support/scripted_device.hpp"

namespace recald::modbus::connection_test {
namespace {

using namespace std::chrono_literals;
using recald::testing::Bytes;
using recald::testing::Piece;
using recald::testing::Script;
using recald::testing::ScriptedLine;
using recald::testing::ScriptedServer;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr ReadRequest kTwoRegisters{7, Function::read_holding_registers, 100, 2};

/// A right reply whose registers hold `value` and the address asked for.
Bytes pdu_of(const Bytes& request_pdu, std::uint8_t value) {
  const std::uint8_t count = request_pdu[4];
  Bytes pdu{request_pdu[0], static_cast<std::uint8_t>(2 * count)};
  for (int i = 0; i < count; ++i) {
    pdu.push_back(value);
    pdu.push_back(static_cast<std::uint8_t>(request_pdu[2] + i));
  }
  return pdu;
}

Bytes tcp_reply(const Bytes& request, std::uint8_t value = 0) {
  const Bytes pdu = pdu_of(Bytes(request.begin() + 7, request.end()), value);
  Bytes reply{request[0], request[1], 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1),
              request[6]};
  reply.insert(reply.end(), pdu.begin(), pdu.end());
  return reply;
}

Bytes with_crc(Bytes frame) {
  const std::uint16_t crc = crc16(frame);
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  return frame;
}

Bytes rtu_reply(const Bytes& request, std::uint8_t value = 0) {
  Bytes reply{request[0]};
  const Bytes pdu = pdu_of(Bytes(request.begin() + 1, request.end() - 2), value);
  reply.insert(reply.end(), pdu.begin(), pdu.end());
  return with_crc(reply);
}

Connection to(const ScriptedServer& server) {
  return Connection{TcpEndpoint{.host = "127.0.0.1", .port = server.port()}};
}

Connection to(const ScriptedLine& line) {
  return Connection{SerialPort{.device = line.device(), .baud = 115'200}};
}

void expect_fault(const ReadResult& result, ReadFault fault) {
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().fault, fault) << result.error().what;
}

/// Unit 7, registers 100 and 101 of a reply that holds `value`.
void expect_value(const ReadResult& result, std::uint16_t value) {
  ASSERT_TRUE(result.has_value()) << result.error().what;
  EXPECT_THAT(*result, ElementsAre(256 * value + 100, 256 * value + 101));
}

TEST(ModbusTcp, ReadsOverOneConnection) {
  ScriptedServer server{[](const Bytes& request, int number) {
    return std::vector<Piece>{{0ms, tcp_reply(request, static_cast<std::uint8_t>(number))}};
  }};
  Connection connection = to(server);
  for (std::uint16_t i = 0; i < 5; ++i) expect_value(connection.read(kTwoRegisters, 1s), i);
  EXPECT_EQ(server.connections(), 1);
}

// late_reply_then_good: the reply comes after the deadline; the next value is its own.
TEST(ModbusTcp, LateReplyThenGood) {
  ScriptedServer server{[](const Bytes& request, int number) {
    return std::vector<Piece>{
        {number == 0 ? 150ms : 0ms, tcp_reply(request, static_cast<std::uint8_t>(number))}};
  }};
  Connection connection = to(server);
  expect_fault(connection.read(kTwoRegisters, 60ms), ReadFault::timeout);
  EXPECT_FALSE(connection.is_open());
  for (std::uint16_t i = 1; i < 4; ++i) expect_value(connection.read(kTwoRegisters, 1s), i);
}

// A gateway that answers each request with the answer to the one before, whatever connection asks.
TEST(ModbusTcp, AnAnswerToAnEarlierRequestIsNoValueOnAnyConnection) {
  Bytes before;
  ScriptedServer server{[&before](const Bytes& request, int number) {
    const Bytes late = std::exchange(before, tcp_reply(request, static_cast<std::uint8_t>(number)));
    return late.empty() ? std::vector<Piece>{} : std::vector<Piece>{{0ms, late}};
  }};
  Connection connection = to(server);
  for (int i = 0; i < 4; ++i)
    expect_fault(connection.read(kTwoRegisters, 60ms), ReadFault::timeout);
  Connection another = to(server);
  expect_fault(another.read(kTwoRegisters, 60ms), ReadFault::timeout);
}

TEST(ModbusTcp, ALateAnswerIsThrownAwayAndTheOwnOneTaken) {
  Bytes first;
  std::vector<std::uint16_t> transactions;
  ScriptedServer server{[&](const Bytes& request, int number) {
    transactions.push_back(static_cast<std::uint16_t>(request[0] << 8 | request[1]));
    const Bytes own = tcp_reply(request, static_cast<std::uint8_t>(number));
    if (number == 0) first = own;
    if (number != 1) return std::vector<Piece>{{0ms, own}};
    Bytes both = first;
    both.insert(both.end(), own.begin(), own.end());
    return std::vector<Piece>{{0ms, both}};
  }};
  Connection connection = to(server);
  for (std::uint16_t i = 0; i < 3; ++i) expect_value(connection.read(kTwoRegisters, 1s), i);
  EXPECT_EQ(server.connections(), 1);
  EXPECT_EQ(std::set<std::uint16_t>(transactions.begin(), transactions.end()).size(), 3U);
}

// Some devices send no transaction back.
TEST(ModbusTcp, ADeviceThatAlwaysSendsTransactionZeroIsRead) {
  ScriptedServer server{[](const Bytes& request, int number) {
    Bytes reply = tcp_reply(request, static_cast<std::uint8_t>(number));
    reply[0] = reply[1] = 0;
    return std::vector<Piece>{{0ms, reply}};
  }};
  Connection connection = to(server);
  for (std::uint16_t i = 0; i < 3; ++i) expect_value(connection.read(kTwoRegisters, 1s), i);
}

TEST(ModbusTcp, SplitAndGluedFrames) {
  ScriptedServer server{[](const Bytes& request, int number) {
    const Bytes whole = tcp_reply(request, static_cast<std::uint8_t>(number));
    if (number == 0) {
      return std::vector<Piece>{{0ms, {whole.begin(), whole.begin() + 3}},
                                {30ms, {whole.begin() + 3, whole.begin() + 9}},
                                {30ms, {whole.begin() + 9, whole.end()}}};
    }
    Bytes glued = whole;
    if (number == 1) glued.insert(glued.end(), whole.begin(), whole.end());
    return std::vector<Piece>{{0ms, glued}};
  }};
  Connection connection = to(server);
  expect_value(connection.read(kTwoRegisters, 1s), 0);
  expect_fault(connection.read(kTwoRegisters, 1s), ReadFault::mismatch);
  expect_value(connection.read(kTwoRegisters, 1s), 2);
}

// One byte every 40 ms: each arrives in time, the reply, after 520 ms, does not.
TEST(ModbusTcp, DrippingBytesDoNotMoveTheDeadline) {
  ScriptedServer server{[](const Bytes& request, int) {
    std::vector<Piece> pieces;
    for (const std::uint8_t byte : tcp_reply(request)) pieces.push_back({40ms, {byte}});
    return pieces;
  }};
  Connection connection = to(server);
  expect_fault(connection.read(kTwoRegisters, 200ms), ReadFault::timeout);
}

TEST(ModbusTcp, TruncatedEverywhere) {
  ScriptedServer server{[](const Bytes& request, int number) {
    const Bytes whole = tcp_reply(request, 1);
    const auto kept = number % static_cast<int>(whole.size());
    if (kept == 0) return std::vector<Piece>{{0ms, {}}};
    return std::vector<Piece>{{0ms, {whole.begin(), whole.begin() + kept}}, {0ms, {}}};
  }};
  Connection connection = to(server);
  for (int i = 0; i < 13; ++i) {
    const auto result = connection.read(kTwoRegisters, 300ms);
    ASSERT_FALSE(result.has_value()) << i;
    EXPECT_NE(result.error().fault, ReadFault::exception) << i;
  }
}

TEST(ModbusTcp, WrongFieldsCostTheConnectionAndNothingElse) {
  const std::vector<std::pair<std::size_t, std::uint8_t>> changes{
      {2, 0x01}, {5, 0x06}, {5, 0x28}, {6, 99}, {7, 0x04}};  // of another transaction: late
  ScriptedServer server{[&](const Bytes& request, int number) {
    Bytes reply = tcp_reply(request, 2);
    if (number % 2 == 0) {
      const auto& [at, byte] = changes[static_cast<std::size_t>(number / 2)];
      reply[at] = byte;
    }
    return std::vector<Piece>{{0ms, reply}};
  }};
  Connection connection = to(server);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    SCOPED_TRACE(changes[i].first);
    expect_fault(connection.read(kTwoRegisters, 300ms), ReadFault::mismatch);
    EXPECT_FALSE(connection.is_open());
    expect_value(connection.read(kTwoRegisters, 1s), 2);
  }
}

// reply_to_nobody: bytes that nobody asked for are not the next reply.
TEST(ModbusTcp, ReplyToNobody) {
  ScriptedServer server{[](const Bytes& request, int number) {
    std::vector<Piece> pieces{{0ms, tcp_reply(request, static_cast<std::uint8_t>(number))}};
    if (number == 0) pieces.push_back({30ms, tcp_reply(request, 99)});
    return pieces;
  }};
  Connection connection = to(server);
  expect_value(connection.read(kTwoRegisters, 1s), 0);
  server.wait_until_played(1);
  expect_value(connection.read(kTwoRegisters, 1s), 1);
  EXPECT_EQ(server.connections(), 2);
}

TEST(ModbusTcp, AnExceptionKeepsTheConnection) {
  ScriptedServer server{[](const Bytes& request, int number) {
    Bytes reply{request[0], request[1], 0, 0, 0, 3, request[6], 0x83, 0x0B};
    return std::vector<Piece>{{0ms, number == 0 ? reply : tcp_reply(request, 3)}};
  }};
  Connection connection = to(server);
  const auto result = connection.read(kTwoRegisters, 1s);
  expect_fault(result, ReadFault::exception);
  EXPECT_EQ(result.error().exception_code, 0x0B);
  expect_value(connection.read(kTwoRegisters, 1s), 3);
  EXPECT_EQ(server.connections(), 1);
}

// endpoint_reboot, idle time-out of a gateway: closed between two reads, and nothing is missed.
TEST(ModbusTcp, AConnectionThatWentStaleIsMadeAnew) {
  ScriptedServer server{[](const Bytes& request, int number) {
    std::vector<Piece> pieces{{0ms, tcp_reply(request, static_cast<std::uint8_t>(number))}};
    if (number == 0) pieces.push_back({0ms, {}});
    return pieces;
  }};
  Connection connection = to(server);
  expect_value(connection.read(kTwoRegisters, 1s), 0);
  server.wait_until_played(1);
  expect_value(connection.read(kTwoRegisters, 1s), 1);
  EXPECT_EQ(server.connections(), 2);
}

TEST(ModbusTcp, ADeviceThatAlwaysClosesIsToldAsClosed) {
  ScriptedServer server{[](const Bytes&, int) { return std::vector<Piece>{{0ms, {}}}; }};
  Connection connection = to(server);
  expect_fault(connection.read(kTwoRegisters, 1s), ReadFault::closed);
  EXPECT_EQ(server.requests(), 1);
}

// half_open_connection: the peer lost power, so nothing comes and no connection ends. Our own
// deadline finds it, and the next read has a connection of its own.
TEST(ModbusTcp, HalfOpenConnection) {
  ScriptedServer server{[](const Bytes& request, int number) -> std::vector<Piece> {
    if (number == 1) return {};
    return {{0ms, tcp_reply(request, static_cast<std::uint8_t>(number))}};
  }};
  Connection connection = to(server);
  expect_value(connection.read(kTwoRegisters, 1s), 0);
  expect_fault(connection.read(kTwoRegisters, 200ms), ReadFault::timeout);
  EXPECT_FALSE(connection.is_open());
  expect_value(connection.read(kTwoRegisters, 1s), 2);
  EXPECT_EQ(server.connections(), 2);
}

// single_connection_device: while one connection lives no other is served. All units behind an
// endpoint share ours, and it is closed before another one is made.
TEST(ModbusTcp, SingleConnectionDevice) {
  ScriptedServer server{[](const Bytes& request, int number) -> std::vector<Piece> {
    if (number == 2) return {};
    return {{0ms, tcp_reply(request, static_cast<std::uint8_t>(number))}};
  }};
  Connection connection = to(server);
  ReadRequest neighbour = kTwoRegisters;
  neighbour.unit = 8;
  expect_value(connection.read(kTwoRegisters, 1s), 0);
  expect_value(connection.read(neighbour, 1s), 1);
  EXPECT_EQ(server.connections(), 1);
  expect_fault(connection.read(kTwoRegisters, 200ms), ReadFault::timeout);
  expect_value(connection.read(neighbour, 5s), 3);
  EXPECT_EQ(server.connections(), 2);
}

TEST(ModbusTcp, NobodyListens) {
  std::uint16_t port = 0;
  {
    ScriptedServer server{[](const Bytes&, int) { return std::vector<Piece>{}; }};
    port = server.port();
  }
  Connection connection{TcpEndpoint{.host = "127.0.0.1", .port = port}};
  const auto result = connection.read(kTwoRegisters, 1s);
  expect_fault(result, ReadFault::refused);
  EXPECT_THAT(result.error().what, HasSubstr("127.0.0.1:" + std::to_string(port)));
}

TEST(ModbusTcp, TooManyOpenFilesAreRefusedBeforeLibmodbusAborts) {
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
  if (limit.rlim_cur < 1000) GTEST_SKIP() << "the limit of open files is " << limit.rlim_cur;
  ScriptedServer server{[](const Bytes& request, int) {
    return std::vector<Piece>{{0ms, tcp_reply(request)}};
  }};
  std::vector<int> files;
  while (files.empty() || files.back() < 900) files.push_back(::open("/dev/null", O_RDONLY));
  Connection connection = to(server);
  const auto result = connection.read(kTwoRegisters, 1s);
  for (const int file : files) ::close(file);
  expect_fault(result, ReadFault::refused);
  EXPECT_THAT(result.error().what, HasSubstr("more than 900 files"));
  expect_value(connection.read(kTwoRegisters, 1s), 0);
}

TEST(ModbusRtu, ReadsAndSurvivesALateReply) {
  ScriptedLine line{[](const Bytes& request, int number) {
    return std::vector<Piece>{
        {number == 1 ? 200ms : 0ms, rtu_reply(request, static_cast<std::uint8_t>(number))}};
  }};
  Connection connection = to(line);
  expect_value(connection.read(kTwoRegisters, 1s), 0);
  expect_fault(connection.read(kTwoRegisters, 60ms), ReadFault::timeout);
  EXPECT_TRUE(connection.is_open());
  line.wait_until_played(2);
  expect_value(connection.read(kTwoRegisters, 1s), 2);
}

// rtu_same_length_swap: the late reply to another register, of the same length, is not believed.
TEST(ModbusRtu, ALateReplyOfTheSameLengthIsNotAnotherRegistersValue) {
  ScriptedLine line{[](const Bytes& request, int number) {
    return std::vector<Piece>{
        {number == 0 ? 250ms : 50ms, rtu_reply(request, static_cast<std::uint8_t>(number))}};
  }};
  Connection connection = to(line);
  expect_fault(connection.read(kTwoRegisters, 100ms), ReadFault::timeout);
  // The line is silent for longer than 50 ms, so this request meets the late reply.
  ReadRequest other = kTwoRegisters;
  other.address = 50;
  const auto swapped = connection.read(other, 1s);
  if (swapped) {
    EXPECT_THAT(*swapped, ElementsAre(256 + 50, 256 + 51));
  } else {
    EXPECT_EQ(swapped.error().fault, ReadFault::mismatch);
  }
  line.wait_until_played(2);
  expect_value(connection.read(kTwoRegisters, 1s), 2);
}

TEST(ModbusRtu, TheLineIsSilentBeforeTheNextRequest) {
  ScriptedLine line{[](const Bytes& request, int number) {
    std::vector<Piece> pieces{{0ms, {7, 0x03}}};  // begins like a reply
    if (number > 0) return std::vector<Piece>{{0ms, rtu_reply(request, 1)}};
    for (int i = 0; i < 60; ++i) pieces.push_back({5ms, {0x55}});
    return pieces;
  }};
  Connection connection = to(line);
  EXPECT_FALSE(connection.read(kTwoRegisters, 100ms).has_value());
  expect_value(connection.read(kTwoRegisters, 1s), 1);
}

TEST(ModbusRtu, NoiseBeforeAFrameCostsOneRead) {
  ScriptedLine line{[](const Bytes& request, int number) {
    Bytes reply = rtu_reply(request, static_cast<std::uint8_t>(number));
    if (number == 0) reply.insert(reply.begin(), {0xFF, 0x00, 0x55});
    return std::vector<Piece>{{0ms, reply}};
  }};
  Connection connection = to(line);
  EXPECT_FALSE(connection.read(kTwoRegisters, 200ms).has_value());
  expect_value(connection.read(kTwoRegisters, 1s), 1);
}

TEST(ModbusRtu, WrongCheckSumAndWrongUnit) {
  ScriptedLine line{[](const Bytes& request, int number) {
    Bytes reply = rtu_reply(request, static_cast<std::uint8_t>(number));
    if (number == 0) reply.back() ^= 0x01;
    if (number == 2) {
      reply.resize(reply.size() - 2);
      reply[0] = 8;
      reply = with_crc(reply);
    }
    return std::vector<Piece>{{0ms, reply}};
  }};
  Connection connection = to(line);
  expect_fault(connection.read(kTwoRegisters, 300ms), ReadFault::crc);
  expect_value(connection.read(kTwoRegisters, 1s), 1);
  const auto of_another = connection.read(kTwoRegisters, 300ms);
  expect_fault(of_another, ReadFault::mismatch);
  EXPECT_EQ(of_another.error().what, "another unit answered");
  expect_value(connection.read(kTwoRegisters, 1s), 3);
}

TEST(ModbusRtu, APortThatDoesNotExist) {
  Connection connection{SerialPort{.device = "/dev/no-such-port"}};
  const auto result = connection.read(kTwoRegisters, 100ms);
  expect_fault(result, ReadFault::refused);
  EXPECT_THAT(result.error().what, HasSubstr("/dev/no-such-port"));
}

TEST(ModbusRtu, ACharacterTakesElevenBitsAt8E1) {
  EXPECT_EQ(line_time({.baud = 9600}, 1).count(), 1145);
  EXPECT_EQ(line_time({.baud = 9600, .parity = Parity::none}, 24).count(), 25'000);
}

Connection rtu_to(const ScriptedServer& server) {
  return Connection{
      TcpEndpoint{.host = "127.0.0.1", .port = server.port(), .has_rtu_frames = true}};
}

TEST(RtuOverTcp, ReadsOverOneConnection) {
  ScriptedServer server{[](const Bytes& request, int number) {
    EXPECT_EQ(crc16(Bytes(request.begin(), request.end() - 2)),
              request.back() << 8 | request[request.size() - 2]);
    const Bytes reply = rtu_reply(request, static_cast<std::uint8_t>(number));
    // Whole, or byte by byte, as a serial server forwards what its line brings.
    if (number % 2 == 0) return std::vector<Piece>{{0ms, reply}};
    std::vector<Piece> pieces;
    for (const std::uint8_t byte : reply) pieces.push_back({1ms, {byte}});
    return pieces;
  }};
  Connection connection = rtu_to(server);
  for (std::uint16_t i = 0; i < 6; ++i) expect_value(connection.read(kTwoRegisters, 1s), i);
  EXPECT_EQ(server.connections(), 1);
}

TEST(RtuOverTcp, AnExceptionKeepsTheConnection) {
  ScriptedServer server{[](const Bytes& request, int number) {
    const Bytes refusal = with_crc({request[0], static_cast<std::uint8_t>(request[1] | 0x80), 2});
    return std::vector<Piece>{{0ms, number == 0 ? refusal : rtu_reply(request, 5)}};
  }};
  Connection connection = rtu_to(server);
  expect_fault(connection.read(kTwoRegisters, 1s), ReadFault::exception);
  expect_value(connection.read(kTwoRegisters, 1s), 5);
  EXPECT_EQ(server.connections(), 1);
}

// Each byte of a reply wrong once: nothing but the right value is ever taken.
TEST(RtuOverTcp, ADamagedByteIsNoValue) {
  for (std::size_t at = 0; at < 9; ++at) {
    ScriptedServer server{[at](const Bytes& request, int number) {
      Bytes reply = rtu_reply(request, 5);
      if (number == 0) reply[at] ^= 0x10;
      return std::vector<Piece>{{0ms, reply}};
    }};
    Connection connection = rtu_to(server);
    EXPECT_FALSE(connection.read(kTwoRegisters, 100ms).has_value()) << at;
    expect_value(connection.read(kTwoRegisters, 1s), 5);
  }
}

// A server passes the late reply to a request that was given up on to the next connection.
TEST(RtuOverTcp, ALateReplyIsNotAnotherRegistersValue) {
  Bytes late;
  ScriptedServer server{[&late](const Bytes& request, int) {
    const Bytes before = std::exchange(late, rtu_reply(request, 1));
    return before.empty() ? std::vector<Piece>{} : std::vector<Piece>{{0ms, before}};
  }};
  Connection connection = rtu_to(server);
  expect_fault(connection.read(kTwoRegisters, 60ms), ReadFault::timeout);
  ReadRequest other = kTwoRegisters;
  other.address = 200;
  EXPECT_FALSE(connection.read(other, 60ms).has_value());
}

}  // namespace
}  // namespace recald::modbus::connection_test
