#include "simulators/devices/fault_script.hpp"

#include <gmock/gmock.h>

namespace recald::simulators::fault_script_test {
namespace {

using namespace std::chrono_literals;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::string_view kScript = R"(# everything at once
1m..5m   unit 2  silent            # no answer
5m..6m   unit 1  late 800ms
6m..7m   unit 1  split 30ms
7m..8m   unit 1  wrong_unit 9
8m..9m   unit 1  wrong_length 40
9m..10m  unit 1  wrong_count 8
10m..11m unit 1  exception 11
11m..12m unit 1  flip 75
at 12m   unit 1  reset 0
13m..14m unit 1  register 0

90s..2h  all     refuse
)";

TEST(FaultScript, SaysWhatIsInForce) {
  const auto script = parse_fault_script(kScript);
  ASSERT_TRUE(script.has_value()) << script.error().message;
  EXPECT_THAT(script->faults, SizeIs(11));
  EXPECT_THAT(script->at(0s, 2), SizeIs(0));
  ASSERT_THAT(script->at(60s, 2), SizeIs(1));
  EXPECT_EQ(script->at(60s, 2)[0].kind, DeviceFaultKind::silent);
  EXPECT_THAT(script->at(60s, 1), SizeIs(0));
  const auto late = script->at(5min + 59s, 1);
  ASSERT_THAT(late, SizeIs(2));
  EXPECT_EQ(late[0].kind, DeviceFaultKind::late);
  EXPECT_EQ(late[0].amount, 800.0);
  EXPECT_EQ(late[1].kind, DeviceFaultKind::refuse);
  EXPECT_EQ(script->at(6min, 1)[0].kind, DeviceFaultKind::split);
  const auto much_later = script->at(3h, 1);
  ASSERT_THAT(much_later, SizeIs(1));  // the reset stays
  EXPECT_EQ(much_later[0].kind, DeviceFaultKind::reset);
}

TEST(FaultScript, EveryWrongLineIsNamed) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"1m..5m unit 2 sleepy", "'sleepy' is no disturbance"},
      {"1m-5m unit 2 silent", "'1m-5m' is no span"},
      {"5m..1m unit 2 silent", "is no span"},
      {"5m..5m unit 2 silent", "is no span"},
      {"at noon unit 2 reset 0", "'noon' is no time"},
      {"1m..5m unit 300 silent", "'300' is no unit"},
      {"1m..5m unit x silent", "'x' is no unit"},
      {"1m..5m unit nan silent", "'nan' is no unit"},
      {"1m..5m unit 1.5 silent", "'1.5' is no unit"},
      {"nanm..infm all silent", "'nanm..infm' is no span"},
      {"1m..5m all \x1B[2J", "'\\x1B[2J' is no disturbance"},
      {"1m..5m meter 2 silent", "'meter' is neither"},
      {"1m..5m unit 2 late", "'late' needs a wait"},
      {"1m..5m unit 2 late fast", "'late' needs a wait"},
      {"1m..5m unit 2 exception", "'exception' needs a number"},
      {"1m..5m unit 2 exception -1", "'exception' needs a number"},
      {"1m..5m unit 2 exception 256", "'exception' needs a number from 0 to 255"},
      {"1m..5m unit 2 flip 1e300", "'flip' needs a number from 0 to 2079"},
      {"1m..5m unit 2 late 1e300h", "'late' needs a wait"},
      {"1m..5m unit 2 silent 3", "'silent' needs nothing after it"},
      {"1m..5m unit 2 exception 3 4", "'4' is one word too many"},
      {"1m..5m unit 2 reset 0", "a reset happens 'at' a time"},
      {"at 5m unit 2 silent", "'silent' lasts from..to"},
  };
  for (const auto& [line, said] : wrong) {
    const auto script = parse_fault_script("# head\n" + line + "\n");
    ASSERT_FALSE(script.has_value()) << line;
    EXPECT_THAT(script.error().message, HasSubstr("line 2: ")) << line;
    EXPECT_THAT(script.error().message, HasSubstr(said)) << line;
  }
  EXPECT_THAT(parse_fault_script("a\nb\n").error().message,
              ContainsRegex("^line 1: [^;]*; line 2: [^;]*$"));
}

}  // namespace
}  // namespace recald::simulators::fault_script_test
