/// What devices answer, byte by byte, and what each disturbance makes of it.
#include "simulators/devices/device_endpoint.hpp"

#include <gmock/gmock.h>

namespace recald::simulators::device_endpoint_test {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr SimulatedTime kBegin = std::chrono::sys_days{2026y / 1 / 30};

/// Two ABB meters of 60 kW, units 1 and 2, that begin at 1 000 and 5 000 kWh.
DeviceEndpoint endpoint_with(const std::string& script, Transport transport = Transport::tcp) {
  const auto load = std::make_shared<const LoadShape>(LoadShape::constant(60.0));
  const DeviceLayout* layout = find_layout("abb-b23");
  return DeviceEndpoint{transport,
                        {{1, layout, load, 1000.0}, {2, layout, load, 5000.0}},
                        parse_fault_script(script).value(),
                        kBegin};
}

DeviceRequest read_of(std::uint8_t unit, std::uint8_t function = 3, std::uint16_t address = 0x5000,
                      std::uint16_t count = 4) {
  const auto low = [](int value) { return static_cast<std::uint8_t>(value & 0xFF); };
  return {0x0102, unit, {function, low(address >> 8), low(address), low(count >> 8), low(count)}};
}

Bytes whole(const std::vector<ReplyPiece>& pieces) {
  Bytes all;
  for (const ReplyPiece& piece : pieces) {
    all.insert(all.end(), piece.bytes.begin(), piece.bytes.end());
  }
  return all;
}

/// The energy in a reply to `read_of(1)`; counts in 0.01 kWh.
double energy_kWh(const std::vector<ReplyPiece>& pieces) {
  const Bytes frame = whole(pieces);
  EXPECT_EQ(frame.size(), 17U);
  double raw = 0.0;
  for (std::size_t i = 9; i < frame.size(); ++i) raw = 256.0 * raw + frame[i];
  return raw / 100.0;
}

// 1 000 kWh are 100 000 steps of 0.01 kWh: 0x0001 86A0.
const Bytes kHonest{1, 2, 0, 0, 0, 11, 1, 3, 8, 0, 0, 0, 0, 0, 1, 0x86, 0xA0};

TEST(DeviceEndpoint, AnswersForEachUnit) {
  DeviceEndpoint endpoint = endpoint_with("");
  EXPECT_THAT(whole(endpoint.answer(read_of(1), kBegin)), ElementsAreArray(kHonest));
  EXPECT_EQ(energy_kWh(endpoint.answer(read_of(1), kBegin + 90min)), 1090.0);
  EXPECT_EQ(energy_kWh(endpoint.answer(read_of(2), kBegin + 90min)), 5090.0);
  EXPECT_EQ(endpoint.requests(), 3);
}

TEST(DeviceEndpoint, SaysWhyNot) {
  DeviceEndpoint endpoint = endpoint_with("");
  const auto code = [&](const DeviceRequest& request) {
    const Bytes frame = whole(endpoint.answer(request, kBegin));
    EXPECT_EQ(frame.size(), 9U);
    EXPECT_EQ(frame.at(7), request.pdu[0] | 0x80);
    return static_cast<int>(frame.at(8));
  };
  EXPECT_EQ(code(read_of(1, 4)), 1);
  EXPECT_EQ(code(read_of(1, 43)), 1);
  EXPECT_EQ(code(read_of(1, 3, 0x4FFF)), 2);
  EXPECT_EQ(code(read_of(1, 3, 0x5000, 0)), 3);
  EXPECT_EQ(code(read_of(1, 3, 0x5000, 126)), 3);
  EXPECT_EQ(code({0, 1, {3, 0x50, 0, 0}}), 3);
  EXPECT_EQ(code(read_of(3)), 11);
  EXPECT_THAT(endpoint_with("", Transport::rtu).answer(read_of(3), kBegin), IsEmpty());
}

TEST(DeviceEndpoint, WritesAreRefusedAndCounted) {
  DeviceEndpoint endpoint = endpoint_with("");
  for (const int function : {5, 6, 15, 16, 22, 23}) {
    EXPECT_EQ(whole(endpoint.answer(read_of(1, static_cast<std::uint8_t>(function)), kBegin)).at(8),
              1);
  }
  (void)endpoint.answer(read_of(1, 4), kBegin);
  EXPECT_EQ(endpoint.writes(), 6);
  EXPECT_EQ(endpoint.requests(), 7);
  EXPECT_EQ(energy_kWh(endpoint.answer(read_of(1), kBegin)), 1000.0);
}

TEST(DeviceEndpoint, EachFaultDoesWhatItsNameSays) {
  const auto answer = [](const std::string& fault) {
    DeviceEndpoint endpoint = endpoint_with("0s..1m unit 1 " + fault);
    EXPECT_EQ(energy_kWh(endpoint.answer(read_of(2), kBegin)), 5000.0) << fault;
    EXPECT_EQ(energy_kWh(endpoint.answer(read_of(1), kBegin + 1min)), 1001.0) << fault;
    return endpoint.answer(read_of(1), kBegin);
  };
  const auto changed = [&](const std::string& fault) { return whole(answer(fault)); };
  const auto honest_but = [](std::size_t at, std::uint8_t value) {
    Bytes frame = kHonest;
    frame[at] = value;
    return frame;
  };
  EXPECT_THAT(answer("silent"), IsEmpty());
  EXPECT_THAT(answer("refuse"), IsEmpty());
  EXPECT_EQ(changed("wrong_unit 9"), honest_but(6, 9));
  EXPECT_EQ(changed("wrong_length 40"), honest_but(5, 40));
  EXPECT_EQ(changed("wrong_count 6"), honest_but(8, 6));
  EXPECT_EQ(changed("flip 75"), honest_but(9, 8));
  EXPECT_EQ(changed("flip 1000"), kHonest);
  EXPECT_THAT(changed("exception 6"), ElementsAre(1, 2, 0, 0, 0, 3, 1, 0x83, 6));
  EXPECT_EQ(changed("late 800ms"), kHonest);
  EXPECT_EQ(answer("late 800ms").at(0).wait, 800ms);
  EXPECT_EQ(energy_kWh(answer("register 7")), 7.0);
}

TEST(DeviceEndpoint, SplitRepliesComeInThreePieces) {
  for (const Transport transport : {Transport::tcp, Transport::rtu}) {
    DeviceEndpoint endpoint = endpoint_with("0s..1m all split 30ms", transport);
    DeviceEndpoint undisturbed = endpoint_with("", transport);
    const auto pieces = endpoint.answer(read_of(1), kBegin);
    ASSERT_THAT(pieces, SizeIs(3));
    EXPECT_EQ(pieces[0].wait, 0ms);
    EXPECT_EQ(pieces[1].wait, 30ms);
    EXPECT_EQ(pieces[2].wait, 30ms);
    EXPECT_EQ(pieces[0].bytes.size(), pdu_begin(transport));
    EXPECT_THAT(pieces[2].bytes, ::testing::Not(IsEmpty()));
    EXPECT_EQ(whole(pieces), whole(undisturbed.answer(read_of(1), kBegin)));
  }
}

TEST(DeviceEndpoint, OnALineOnlyTheFlipBreaksTheCheckSum) {
  const auto frame_is_sound = [](const std::string& script) {
    DeviceEndpoint endpoint = endpoint_with(script, Transport::rtu);
    const Bytes frame = whole(endpoint.answer(read_of(1), kBegin));
    const Bytes closed =
        reply_frame(Transport::rtu, {}, frame.at(0), Bytes(frame.begin() + 1, frame.end() - 2));
    return closed == frame;
  };
  EXPECT_TRUE(frame_is_sound(""));
  EXPECT_TRUE(frame_is_sound("0s..1m all wrong_unit 9"));
  EXPECT_TRUE(frame_is_sound("0s..1m all wrong_count 9"));
  EXPECT_TRUE(frame_is_sound("0s..1m all exception 4"));
  EXPECT_TRUE(frame_is_sound("0s..1m all wrong_length 40"));  // a line has no length to be wrong
  EXPECT_FALSE(frame_is_sound("0s..1m all flip 30"));
}

TEST(DeviceEndpoint, AResetCounterGoesOnFromThere) {
  DeviceEndpoint endpoint = endpoint_with("at 1h unit 1 reset 0\nat 3h unit 1 reset 50");
  const auto at = [&](std::chrono::minutes t) {
    return energy_kWh(endpoint.answer(read_of(1), kBegin + t));
  };
  EXPECT_EQ(at(59min), 1059.0);
  EXPECT_EQ(at(60min), 0.0);
  EXPECT_EQ(at(90min), 30.0);
  EXPECT_EQ(at(181min), 51.0);
}

TEST(DeviceEndpoint, ABouncingCounterReturnsToItsOldLine) {
  DeviceEndpoint endpoint = endpoint_with("1h..2h unit 1 register 0");
  EXPECT_EQ(energy_kWh(endpoint.answer(read_of(1), kBegin + 90min)), 0.0);
  EXPECT_EQ(energy_kWh(endpoint.answer(read_of(1), kBegin + 2h)), 1120.0);
}

TEST(DeviceEndpoint, KnowsWhenItIsAway) {
  const DeviceEndpoint endpoint = endpoint_with("1m..2m all refuse\n90s..3m unit 2 refuse");
  EXPECT_FALSE(endpoint.refuses(kBegin));
  EXPECT_TRUE(endpoint.refuses(kBegin + 1min));
  EXPECT_TRUE(endpoint.refuses(kBegin + 2min));
  EXPECT_FALSE(endpoint.refuses(kBegin + 3min));
  EXPECT_EQ(endpoint.next_refusal_change(kBegin), kBegin + 1min);
  EXPECT_EQ(endpoint.next_refusal_change(kBegin + 2min), kBegin + 3min);
  EXPECT_FALSE(endpoint.next_refusal_change(kBegin + 3min).has_value());
}

}  // namespace
}  // namespace recald::simulators::device_endpoint_test
