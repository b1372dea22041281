/// The chain of models of SunSpec devices, over real sockets.
#include "adapters/modbus/sunspec.hpp"

#include <gmock/gmock.h>

#include "adapters/modbus/connection.hpp"
#include "adapters/modbus/sunspec_bus.hpp"
#include "tests/support/register_device.hpp"

namespace recald::modbus::sunspec_test {
namespace {

using recald::testing::put_words;
using recald::testing::register_device;
using recald::testing::Registers;
using recald::testing::ScriptedServer;
using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::uint16_t kEnd = 0xFFFF;

/// "SunS" at `base`, then models of the given ids and lengths full of zeros, then the end mark.
Registers chain(int base, const std::vector<std::pair<std::uint16_t, std::uint16_t>>& models) {
  Registers registers;
  put_words(registers, base, {0x5375, 0x6E53});
  int at = base + 2;
  for (const auto& [id, length] : models) {
    put_words(registers, at, {id, length});
    put_words(registers, at + 2, std::vector<std::uint16_t>(length));
    at += 2 + length;
  }
  put_words(registers, at, {kEnd, 0});
  return registers;
}

SunSpecWalk walked(const Registers& registers, std::vector<std::uint16_t> wanted = {}) {
  ScriptedServer device{register_device(registers)};
  Connection connection{TcpEndpoint{.host = "127.0.0.1", .port = device.port()}};
  SunSpecWalk walk{1, std::move(wanted)};
  while (const auto request = walk.next()) {
    walk.take(connection.read(*request, std::chrono::seconds{5}));
  }
  return walk;
}

TEST(SunSpec, TheChainIsFoundAtEachOfItsAddresses) {
  for (const int base : {40'000, 50'000, 0}) {
    const SunSpecWalk walk = walked(chain(base, {{1, 66}, {203, 105}}));
    EXPECT_THAT(walk.models(),
                ElementsAre(SunSpecModel{1, static_cast<std::uint16_t>(base + 2), 66},
                            SunSpecModel{203, static_cast<std::uint16_t>(base + 70), 105}))
        << base;
  }
}

TEST(SunSpec, TheWalkEndsAtWhatIsWanted) {
  const SunSpecWalk walk = walked(chain(40'000, {{1, 66}, {203, 105}, {204, 105}}), {204, 203});
  EXPECT_EQ(walk.found(), (SunSpecModel{203, 40'070, 105}));
  EXPECT_EQ(walk.models().size(), 2u);
}

TEST(SunSpec, AChainWithoutAnEndMarkEnds) {
  Registers registers = chain(40'000, {{1, 66}});
  registers.erase(40'070);
  EXPECT_EQ(walked(registers).models().size(), 1u);
}

TEST(SunSpec, WhatIsNotThereIsASentence) {
  EXPECT_THAT(walked(chain(40'000, {{1, 66}, {103, 50}}), {203}).failure().what,
              HasSubstr("has the models 1, 103, and none of 203"));
  EXPECT_THAT(walked({}, {203}).failure().what,
              HasSubstr("\"SunS\" stands at none of the addresses 40000, 50000, 0"));
  Registers other;
  put_words(other, 40'000, {0x5375, 0x6E54});
  EXPECT_EQ(walked(other, {203}).failure().fault, ReadFault::mismatch);
}

TEST(SunSpec, ModelsWithoutLengthDoNotGoOnForEver) {
  Registers registers = chain(0, {});
  for (int at = 2; at < 2000; at += 2) put_words(registers, at, {7, 0});
  EXPECT_EQ(walked(registers, {203}).models().size(), 100u);
}

TEST(SunSpec, AChainEndsWithTheRegisters) {
  Registers registers;
  put_words(registers, 50'000, {0x5375, 0x6E53, 1, 15'531});
  EXPECT_EQ(walked(registers).models().size(), 1u) << "its next header would be at 65535";
}

TEST(SunSpec, SilenceIsNotAMissingModel) {
  SunSpecWalk walk{1, {203}};
  walk.take(tl::unexpected(ReadFailure{ReadFault::timeout, 0, "slow"}));
  EXPECT_FALSE(walk.next().has_value());
  EXPECT_EQ(walk.failure().fault, ReadFault::timeout);
  SunSpecWalk busy{1, {203}};
  busy.take(tl::unexpected(ReadFailure{ReadFault::exception, 6, "busy"}));
  EXPECT_EQ(busy.failure().exception_code, 6);
}

/// Reads at once, over a real connection.
class PlainBus final : public Bus {
 public:
  explicit PlainBus(std::uint16_t port)
      : connection_(TcpEndpoint{.host = "127.0.0.1", .port = port}) {}
  void read(const ReadRequest& request, milliseconds timeout, Done done) override {
    done(connection_.read(request, timeout), milliseconds{1});
  }

 private:
  Connection connection_;
};

/// A device with a SunSpec meter at unit 1, and a bus that finds it.
struct Site {
  explicit Site(Registers content) : registers(std::move(content)) {}

  ReadResult read(std::uint16_t address, std::uint16_t count, std::uint8_t unit = 1) {
    std::optional<ReadResult> outcome;
    bus.read({unit, Function::read_holding_registers, address, count}, std::chrono::seconds{5},
             [&](ReadResult result, milliseconds) { outcome = std::move(result); });
    return outcome.value();
  }

  Registers registers;
  ScriptedServer device{register_device(registers)};
  SunSpecBus bus{std::make_unique<PlainBus>(device.port()), {{1, {201, 202, 203, 204}}}};
};

TEST(SunSpecBus, AddressesCountFromTheModel) {
  Site site{chain(40'000, {{1, 66}, {203, 105}})};
  site.registers[40'070 + 18] = 1234;
  EXPECT_EQ(site.read(18, 1).value(), Words{1234});
  EXPECT_EQ(site.read(0, 2).value(), (Words{203, 105}));
  EXPECT_EQ(site.device.requests(), 3 + 2) << "mark, two headers, then a request each";
}

TEST(SunSpecBus, OtherUnitsAreReadAsTheyAre) {
  Site site{chain(0, {{203, 105}})};
  EXPECT_EQ(site.read(0, 2, 9).value(), (Words{0x5375, 0x6E53}));
}

// The device comes back with another firmware, whose chain has one model more.
TEST(SunSpecBus, AChainThatMovedIsWalkedAgain) {
  Site site{chain(40'000, {{1, 66}, {203, 105}})};
  EXPECT_TRUE(site.read(18, 1).has_value());
  site.registers = chain(50'000, {{1, 66}, {2, 12}, {203, 105}});
  site.registers[50'084 + 18] = 77;
  EXPECT_EQ(site.read(18, 1).value(), Words{77});
}

TEST(SunSpecBus, BeyondTheModelNothingIsRead) {
  Site site{chain(0, {{203, 20}, {204, 105}})};
  const auto beyond = site.read(18, 5);
  ASSERT_FALSE(beyond.has_value());
  EXPECT_EQ(beyond.error().fault, ReadFault::mismatch);
  EXPECT_THAT(beyond.error().what, HasSubstr("model 203 of the device has 22 registers; the map "
                                             "goes to 23"));
  EXPECT_TRUE(site.read(18, 4).has_value());
}

TEST(SunSpecBus, WithoutTheModelItIsLookedForAgain) {
  Site site{chain(40'000, {{1, 66}})};
  EXPECT_THAT(site.read(18, 1).error().what, HasSubstr("none of 201, 202, 203, 204"));
  site.registers = chain(40'000, {{1, 66}, {201, 105}});
  EXPECT_TRUE(site.read(18, 1).has_value()) << "the device had not been ready";
}

TEST(SunSpecBus, ARegisterThatTheDeviceRefusesIsToldAsSuch) {
  Site site{chain(40'000, {{1, 66}, {203, 105}})};
  site.registers.erase(40'070 + 18);
  EXPECT_EQ(site.read(18, 1).error().exception_code, 2);
}

// A device that was silent may have got another firmware: its chain is walked again, although the
// old place would answer.
TEST(SunSpecBus, AfterASilenceTheChainIsWalkedAgain) {
  struct Counted final : Bus {
    explicit Counted(std::vector<ReadRequest>& made) : made_(made) {}
    void read(const ReadRequest& request, milliseconds, Done done) override {
      made_.push_back(request);
      static constexpr std::uint16_t kChain[] = {0x5375, 0x6E53, 203, 105};
      if (made_.size() == 4) {
        done(tl::unexpected(ReadFailure{ReadFault::timeout}), milliseconds{1});
      } else if (request.address < 40'004) {
        const auto* at = kChain + (request.address - 40'000);
        done(Words(at, at + request.count), milliseconds{1});
      } else {
        done(Words(request.count), milliseconds{1});
      }
    }
    std::vector<ReadRequest>& made_;
  };
  std::vector<ReadRequest> made;
  SunSpecBus bus{std::make_unique<Counted>(made), {{1, {203}}}};
  std::vector<bool> outcomes;
  for (int i = 0; i < 3; ++i) {
    bus.read({1, Function::read_holding_registers, 18, 1}, milliseconds{1},
             [&](const ReadResult& result, milliseconds) { outcomes.push_back(!!result); });
  }
  EXPECT_THAT(outcomes, ElementsAre(true, false, true));
  ASSERT_EQ(made.size(), 7u);
  EXPECT_EQ(made[3].address, 40'020) << "known: asked for at once";
  EXPECT_EQ(made[4].address, 40'000) << "looked for anew";
}

TEST(SunSpecBus, WhatIsUnderWayAtItsEndIsNotTold) {
  struct Held final : Bus {
    explicit Held(Done& done) : done_(done) {}
    void read(const ReadRequest&, milliseconds, Done done) override { done_ = std::move(done); }
    Done& done_;
  };
  Bus::Done held;
  bool told = false;
  {
    SunSpecBus bus{std::make_unique<Held>(held), {{1, {203}}}};
    bus.read({1, Function::read_holding_registers, 18, 1}, milliseconds{1},
             [&](ReadResult, milliseconds) { told = true; });
  }
  held(Words{0, 0}, milliseconds{1});
  EXPECT_FALSE(told);
}

}  // namespace
}  // namespace recald::modbus::sunspec_test
