#include "daemon/gateway/recording/line.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace recald::daemon::recording_test {
namespace {

using namespace recald::daemon::recording;
using metering::Instant;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

constexpr Moment kAt{WallTime{milliseconds{1'709'078'400'123}}, milliseconds{45}};

/// One of each kind, with what is hard to write.
std::vector<Line> every_kind() {
  const metering::Reading hard{.meter = 0,
                               .start = Instant{seconds{1'709'078'400}},
                               .mean_kW = 0.1 + 0.2,
                               .validity = metering::Validity::scaled,
                               .reasons = metering::Reason::manual,
                               .late = true};
  const metering::Reading none{.meter = 0,
                               .start = hard.start,
                               .mean_kW = std::numeric_limits<double>::quiet_NaN(),
                               .validity = metering::Validity::missing};
  const Read answered{.meter = "\"main\"\n",
                      .read = 2,
                      .request = {247, modbus::Function::read_input_registers, 65'533, 3},
                      .due = kAt.wall,
                      .is_probe = true,
                      .result = modbus::Words{0, 65'535, 7},
                      .duration = milliseconds{12}};
  Read failed = answered;
  failed.result =
      tl::unexpected(modbus::ReadFailure{modbus::ReadFault::exception, 11, "no answer: \xff"});
  Read silent = answered;
  silent.result = tl::unexpected(modbus::ReadFailure{modbus::ReadFault::timeout});
  RegisterState many_pieces{.field = "energy"};  // of an hour that is read every few seconds
  for (int i = 0; i < 900; ++i) {
    const Instant at{seconds{1'709'078'400 + 4 * i}};
    many_pieces.book.pieces.push_back(
        {.span = {at, at + seconds{4}}, .energy_kWh = 0.1 * i, .validity = metering::Validity::ok});
  }
  metering::MonthlyFigure figure{};
  figure.month = std::chrono::year{2024} / 2;
  return {Head{kFormat, "0.9.0", "2025b"},
          SitePart{"", "[site]\nid = \"x\"\n"},
          SitePart{"own.toml", ""},
          KnownMeter{"main", seconds{900}, "rules", Instant{seconds{7}}},
          KnownMeter{"steam", seconds{3'600}, "", {}},
          KnownEvent{{.time = Instant{seconds{4}},
                      .severity = Severity::warning,
                      .kind = "meter_silent",
                      .subject = "main",
                      .text = "it is",
                      .count = 3,
                      .last = Instant{seconds{6}}}},
          KnownRegister{"main", {.field = "energy"}},
          KnownRegister{"main", many_pieces},
          Readings{"main", {hard, none}},
          KnownMonth{"main", {figure, Instant{seconds{8}}, "2025b"}},
          ReopenedMonth{"main", std::chrono::year{2024} / 1},
          Committed{"main", {none, hard}},
          End{"it ended", true},
          Entry{kAt, "no time server is heard", Start{}},
          Entry{kAt, "", answered},
          Entry{kAt, "", failed},
          Entry{kAt, "", silent},
          Entry{kAt, "", Push{"steam", {hard}, Correction{"me", "because", "00ff"}}},
          Entry{kAt, "", Push{"steam", {}, {}}},
          Entry{kAt, "", Value{{"pump", true, 1.0 / 3.0, Instant{seconds{5}}}}},
          Entry{kAt, "", Value{{"pump", false, -2.5e-300, {}}}},
          Entry{kAt, "", Tick::minute},
          Entry{kAt, "", Tick::hour},
          Entry{kAt, "", Tick::step},
          Entry{kAt, "", Reload{}}};
}

TEST(RecordedLine, IsTheSameWhenItIsReadAndWrittenAgain) {
  for (const Line& line : every_kind()) {
    const std::string text = to_text(line);
    SCOPED_TRACE(text);
    EXPECT_EQ(text.find('\n'), text.size() - 1);
    const auto read = parse_line(text);
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->index(), line.index());
    EXPECT_EQ(to_text(*read), text);
  }
}

TEST(RecordedLine, IsRefusedWithoutAnyOfItsParts) {
  for (const Line& line : every_kind()) {
    const std::string text = to_text(line);
    // Without the first number or text after the one that says of which kind it is.
    const std::size_t colon = text.find(':', text.find(',') + 1);
    if (text.find(',') == std::string::npos || colon == std::string::npos) continue;
    SCOPED_TRACE(text);
    const auto read = parse_line(text.substr(0, colon + 1) + "{}" + "}");
    ASSERT_FALSE(read.has_value());
    EXPECT_FALSE(read.error().message.empty());
  }
}

TEST(RecordedLine, SaysWhatIsWrong) {
  const auto refusal = [](std::string_view text) {
    const auto read = parse_line(text);
    return read ? "it was read" : read.error().message;
  };
  EXPECT_THAT(refusal("[1]"), HasSubstr("no JSON object"));
  EXPECT_THAT(refusal("{}"), HasSubstr("no line of a recording"));
  EXPECT_THAT(refusal(R"({"wall_ms":1,"monotonic_ms":1,"read":"m","index":0,"unit":1,"function":3,)"
                      R"("address":0,"count":2,"due_ms":1,"took_ms":1,"registers":[1]})"),
              HasSubstr("'registers' are not 'count' many"));
  EXPECT_THAT(refusal(R"({"wall_ms":1,"monotonic_ms":1,"read":"m","index":0,"unit":1,"function":6,)"
                      R"("address":0,"count":1,"due_ms":1,"took_ms":1,"registers":[1]})"),
              HasSubstr("'function' is 6"));
  EXPECT_THAT(refusal(R"({"wall_ms":99999999999999999,"monotonic_ms":1,"start":true})"),
              HasSubstr("'wall_ms' is 99999999999999999"));
  EXPECT_THAT(refusal(R"({"wall_ms":1,"monotonic_ms":1,"tick":"day"})"), HasSubstr("'tick'"));
  EXPECT_THAT(refusal(R"({"stored":"m","readings":[[1,2]]})"), HasSubstr("no list of 5"));
  EXPECT_THAT(refusal(R"({"stored":[[[[[[[[[[1]]]]]]]]]]})"), HasSubstr("too many brackets"));
}

}  // namespace
}  // namespace recald::daemon::recording_test
