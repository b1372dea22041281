/// The real loop, and the owner thread of a bus that reports to it.
#include "adapters/asio/asio_loop.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <thread>

#include "adapters/modbus/bus_thread.hpp"
#include "tests/support/scripted_device.hpp"

namespace recald::asio {
namespace {

using namespace std::chrono_literals;
using recald::testing::Bytes;
using recald::testing::Piece;
using recald::testing::ScriptedServer;
using ::testing::ElementsAre;

class AsioLoopTest : public ::testing::Test {
 protected:
  boost::asio::io_context context_{1};
  AsioLoop loop_{context_};
};

TEST_F(AsioLoopTest, CallsInOrderOfTimeAndThenOfAsking) {
  std::vector<int> called;
  loop_.after(30ms, [&] { called.push_back(3); });
  loop_.after(0ms, [&] { called.push_back(1); });
  loop_.after(10ms, [&] { called.push_back(2); });
  context_.run();
  EXPECT_THAT(called, ElementsAre(1, 2, 3));
}

TEST_F(AsioLoopTest, ACallIsNotMadeBeforeItsTime) {
  const Moment begin = loop_.now();
  Moment end{};
  loop_.after(50ms, [&] { end = loop_.now(); });
  context_.run();
  EXPECT_GE(end.monotonic - begin.monotonic, 49ms);  // both are cut to whole milliseconds
}

// What goes on by asking for the next call would stand still for ever.
TEST_F(AsioLoopTest, ACallThatThrowsIsMadeAgain) {
  AsioLoop fast{context_, metering::TrialClock{.start = {}, .anchor = {}, .speed = 6000.0}};
  int calls = 0;
  fast.after(1ms, [&] {
    if (++calls < 3) throw std::runtime_error("unforeseen");
  });
  EXPECT_THROW(context_.run(), std::runtime_error);
  EXPECT_THROW(context_.run(), std::runtime_error);
  context_.run();
  EXPECT_EQ(calls, 3);
}

TEST_F(AsioLoopTest, OtherThreadsPostToIt) {
  const auto keep = boost::asio::make_work_guard(context_);
  std::thread::id called_on;
  std::jthread other{[&] {
    loop_.post([&] {
      called_on = std::this_thread::get_id();
      context_.stop();
    });
  }};
  context_.run();
  EXPECT_EQ(called_on, std::this_thread::get_id());
}

TEST_F(AsioLoopTest, TheWallClockIsTheSystems) {
  const auto before = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const auto now = loop_.now().instant();
  EXPECT_GE(now, before);
  EXPECT_LE(now, before + 5s);
}

// A quarter of an hour in a millisecond, on both clocks, and waits that shrink with it.
TEST(AsioLoopTrial, TimeRunsFaster) {
  boost::asio::io_context context{1};
  const auto anchor = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const metering::Instant start = std::chrono::sys_days{std::chrono::year{2026} / 1 / 30};
  AsioLoop loop{context, metering::TrialClock{start, anchor, 900'000.0}};
  const Moment begin = loop.now();
  EXPECT_GE(begin.instant(), start);
  Moment end{};
  loop.after(12h, [&] { end = loop.now(); });
  context.run();
  EXPECT_GE(end.monotonic - begin.monotonic, 12h);
  EXPECT_EQ(end.wall - begin.wall, end.monotonic - begin.monotonic);
}

class BusThreadTest : public AsioLoopTest {
 protected:
  /// Runs the loop until the read has ended.
  modbus::ReadResult read(modbus::BusThread& bus, std::chrono::milliseconds timeout) {
    std::unique_ptr<modbus::ReadResult> outcome;
    std::thread::id told_on;
    const auto keep = boost::asio::make_work_guard(context_);
    bus.read({7, modbus::Function::read_holding_registers, 100, 1}, timeout,
             [&](modbus::ReadResult result, std::chrono::milliseconds) {
               told_on = std::this_thread::get_id();
               outcome = std::make_unique<modbus::ReadResult>(std::move(result));
               context_.stop();
             });
    context_.restart();
    context_.run();
    EXPECT_EQ(told_on, std::this_thread::get_id());
    return *outcome;
  }
  static std::vector<Piece> answer(const Bytes& request, int number) {
    return {{0ms,
             {request[0], request[1], 0, 0, 0, 5, request[6], 0x03, 2, 0,
              static_cast<std::uint8_t>(number)}}};
  }
};

TEST_F(BusThreadTest, ReadsOneAfterTheOther) {
  ScriptedServer server{answer};
  modbus::BusThread bus{modbus::TcpEndpoint{.host = "127.0.0.1", .port = server.port()}, loop_};
  for (std::uint16_t i = 0; i < 5; ++i) {
    const auto words = read(bus, 2s);
    ASSERT_TRUE(words.has_value()) << words.error().what;
    EXPECT_THAT(*words, ElementsAre(i));
  }
  EXPECT_EQ(server.connections(), 1);
}

TEST_F(BusThreadTest, TellsFailures) {
  ScriptedServer server{[](const Bytes&, int) { return std::vector<Piece>{}; }};
  modbus::BusThread bus{modbus::TcpEndpoint{.host = "127.0.0.1", .port = server.port()}, loop_};
  const auto words = read(bus, 50ms);
  ASSERT_FALSE(words.has_value());
  EXPECT_EQ(words.error().fault, modbus::ReadFault::timeout);
}

TEST_F(BusThreadTest, EndsInTheMiddleOfARead) {
  ScriptedServer server{[](const Bytes&, int) { return std::vector<Piece>{}; }};
  bool told = false;
  {
    modbus::BusThread bus{modbus::TcpEndpoint{.host = "127.0.0.1", .port = server.port()}, loop_};
    bus.read({7, modbus::Function::read_holding_registers, 100, 1}, 100ms,
             [&](modbus::ReadResult, std::chrono::milliseconds) { told = true; });
  }
  context_.run();
  EXPECT_FALSE(told);
}

}  // namespace
}  // namespace recald::asio
