/// A live meter from registers to what is stored.
#include "daemon/gateway/ingest/meter_track.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "daemon/site/config/register_map_file.hpp"

namespace recald::daemon::meter_track_test {
namespace {

using metering::Instant;
using metering::Reason;
using metering::Validity;
using modbus::ReadFault;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
constexpr seconds kQuarter{900};

metering::LocalCalendar calendar() {
  auto opened = metering::LocalCalendar::open("Europe/Zurich");
  if (!opened) throw std::runtime_error(opened.error().message);
  return *opened;
}

modbus::RegisterMap map_of(std::string_view text) {
  auto file = parse_register_map(text, "test");
  if (!file) throw std::runtime_error(file.error().front());
  return file->map;
}

constexpr std::string_view kMeter = R"(
source = "the test"
base = 0
energy = ["energy"]
power = "power"
identity = ["serial"]
register.energy = { at = 0, type = "u32", scale = 0.1, unit = "kWh", absent = "0xFFFFFFFF" }
register.power = { at = 2, type = "i32", unit = "W" }
register.serial = { at = 4, type = "u32" }
)";

/// A meter read every minute; what it stored so far.
class Live {
 public:
  explicit Live(std::string_view map = kMeter, double multiplier = 1.0)
      : meter_{.number = 3,
               .id = "main",
               .map = map_of(map),
               .multiplier = multiplier,
               .counter = {.rated_kW = 400.0},
               .booking = {.interval = kQuarter, .sample_gap_max = seconds{120}}},
        fields_{metered_fields(meter_.map)},
        reads_{*plan_reads(fields_, meter_.map.function, meter_.map.limits)},
        track{meter_, calendar(), {}} {}

  /// Registers 0 to 5 at some second.
  void read(seconds after, double energy_kWh, double power_W = 0.0, std::uint32_t serial = 4711) {
    const auto raw = static_cast<std::uint32_t>(std::llround(energy_kWh * 10.0));
    const auto power = static_cast<std::uint32_t>(static_cast<std::int32_t>(power_W));
    take(after,
         modbus::Words{high(raw), low(raw), high(power), low(power), high(serial), low(serial)});
  }
  void fail(seconds after, ReadFault fault, std::uint8_t code = 0) {
    take(after, tl::unexpected(modbus::ReadFailure{fault, code}));
  }
  void take(seconds after, const modbus::ReadResult& result, std::size_t read = 0) {
    const Instant at = kStart + after;
    put(track.take(reads_.at(read), result, at, at));
  }
  void put(const StoreBatch& batch) {
    for (const auto& interval : batch.intervals) {
      intervals[interval.reading.start] = interval.reading;
      if (interval.supersedes) superseding.insert(interval.reading.start);
    }
    events.insert(events.end(), batch.events.begin(), batch.events.end());
    samples.insert(samples.end(), batch.samples.begin(), batch.samples.end());
    if (!batch.registers.empty()) stored = batch.registers.back().state;
  }
  /// The process ends and starts again from what was stored.
  void restart() { track = MeterTrack{meter_, calendar(), stored}; }

  [[nodiscard]] const metering::Reading& quarter(int number) const {
    return intervals.at(kStart + number * kQuarter);
  }

  static std::uint16_t high(std::uint32_t bits) { return static_cast<std::uint16_t>(bits >> 16); }
  static std::uint16_t low(std::uint32_t bits) { return static_cast<std::uint16_t>(bits & 0xFFFF); }

 private:
  TrackedMeter meter_;
  std::vector<modbus::RegisterField> fields_;
  std::vector<modbus::PlannedRead> reads_;

 public:
  MeterTrack track;
  std::map<Instant, metering::Reading> intervals;
  std::set<Instant> superseding;
  std::vector<StoreEvent> events;
  std::vector<RawSample> samples;
  std::optional<RegisterState> stored;
};

TEST(MeterTrack, RegistersBecomeIntervals) {
  Live meter;
  for (int minute = 0; minute <= 31; ++minute)
    meter.read(minutes{minute}, 1000.0 + minute, 60'000.0);
  ASSERT_THAT(meter.intervals, SizeIs(2));
  EXPECT_NEAR(meter.quarter(0).mean_kW, 60.0, 1e-9);
  EXPECT_EQ(meter.quarter(0).meter, 3u);
  EXPECT_EQ(meter.quarter(1).validity, Validity::ok);
  EXPECT_NEAR(*meter.track.live().power_kW, 60.0, 1e-9);
  EXPECT_NEAR(*meter.track.live().register_kWh, 1031.0, 1e-9);
  EXPECT_EQ(meter.track.live().read_at, kStart + minutes{31});
  EXPECT_THAT(meter.events, IsEmpty());
}

TEST(MeterTrack, AFailedReadIsNotTheLastValue) {
  Live meter;
  meter.read(seconds{0}, 1000.0, 60'000.0);
  EXPECT_TRUE(meter.track.live().power_kW.has_value());
  meter.fail(minutes{1}, ReadFault::timeout);
  EXPECT_FALSE(meter.track.live().power_kW.has_value());
  EXPECT_EQ(meter.track.live().read_at, kStart);
}

TEST(MeterTrack, ACurrentTransformerMultiplies) {
  Live meter{kMeter, 40.0};
  for (int minute = 0; minute <= 15; ++minute)
    meter.read(minutes{minute}, 1000.0 + 0.1 * minute, 150.0);
  EXPECT_NEAR(meter.quarter(0).mean_kW, 240.0, 1e-9);
  EXPECT_NEAR(*meter.track.live().power_kW, 6.0, 1e-9);
}

TEST(MeterTrack, TheResolutionIsThatOfTheRegister) {
  Live meter;
  meter.read(seconds{0}, 1000.0);
  EXPECT_NEAR(meter.track.state().settings.resolution_kWh, 0.1, 1e-12);
}

// A failed read is missing: never 0 and never the last value. Why it failed stands in the interval.
TEST(MeterTrack, FailuresLeaveAHoleWithItsReasons) {
  Live meter;
  for (int minute = 0; minute <= 60; ++minute) {
    if (minute > 20 && minute < 25) {
      meter.fail(minutes{minute}, ReadFault::timeout);
    } else if (minute >= 25 && minute < 35) {
      meter.fail(minutes{minute}, ReadFault::exception, 0x0B);
    } else {
      meter.read(minutes{minute}, 1000.0 + minute);
    }
  }
  EXPECT_EQ(meter.quarter(0).reasons, Reason::none);
  for (const int quarter : {1, 2}) {
    EXPECT_EQ(meter.quarter(quarter).validity, Validity::scaled);
    EXPECT_EQ(meter.quarter(quarter).reasons, Reason::timeout | Reason::exception);
    EXPECT_NEAR(meter.quarter(quarter).mean_kW, 60.0, 1e-9);
  }
  EXPECT_EQ(meter.quarter(3).reasons, Reason::none);
}

// all_F: the register's "no value" is not 4 294 967 295.
TEST(MeterTrack, ASentinelIsNoValue) {
  Live meter;
  for (int minute = 0; minute <= 30; ++minute) {
    const bool absent = minute > 10 && minute < 20;
    meter.read(minutes{minute}, absent ? 429'496'729.5 : 1000.0 + minute);
  }
  EXPECT_EQ(meter.quarter(0).validity, Validity::scaled);
  EXPECT_EQ(meter.quarter(0).reasons, Reason::sentinel);
  EXPECT_NEAR(meter.quarter(0).mean_kW + meter.quarter(1).mean_kW, 120.0, 1e-9);
}

TEST(MeterTrack, AnOutageFollowsTheUsualDay) {
  Live meter;
  // Learnt: ten times as much in the second quarter of the day as in the others.
  for (int quarter = 0; quarter < 96; ++quarter) {
    meter.track.remember({3, kStart - std::chrono::days{1} + quarter * kQuarter,
                          quarter == 1 ? 100.0 : 10.0, Validity::ok});
  }
  meter.read(seconds{0}, 1000.0);
  meter.read(minutes{60}, 1032.5);
  EXPECT_NEAR(meter.quarter(1).mean_kW, 100.0, 1e-6);
  EXPECT_NEAR(meter.quarter(2).mean_kW, 10.0, 1e-6);
}

TEST(MeterTrack, EventsAreSentences) {
  Live meter;
  for (int minute = 0; minute <= 10; ++minute) meter.read(minutes{minute}, 5000.0 + minute);
  meter.read(minutes{11}, 0.0);
  meter.read(minutes{12}, 5012.0);
  ASSERT_THAT(meter.events, SizeIs(1));
  EXPECT_EQ(meter.events[0].kind, "counter_bounce");
  EXPECT_EQ(meter.events[0].severity, Severity::info);
  for (int minute = 13; minute <= 20; ++minute) meter.read(minutes{minute}, minute);
  ASSERT_THAT(meter.events, SizeIs(2));
  EXPECT_EQ(meter.events[1].kind, "counter_reset");
  EXPECT_EQ(meter.events[1].subject, "main");
  EXPECT_EQ(meter.events[1].severity, Severity::warning);
  EXPECT_THAT(meter.events[1].text,
              HasSubstr("fell from 5012.0 to 13.0 kWh and stays there, so it was reset"));
  for (int minute = 21; minute <= 30; ++minute) meter.read(minutes{minute}, 90'000.0 + minute);
  ASSERT_THAT(meter.events, SizeIs(3));
  EXPECT_EQ(meter.events[2].kind, "counter_jump");
  EXPECT_THAT(meter.events[2].text, HasSubstr("more than a load of 400 kW can use"));
}

// meter_swap: one odd serial number is a flipped bit, two alike are another device.
TEST(MeterTrack, AnotherDeviceStartsANewCounter) {
  Live meter;
  for (int minute = 0; minute <= 20; ++minute) {
    meter.read(minutes{minute}, 5000.0 + minute, 0.0, minute == 7 ? 4710 : 4711);
  }
  EXPECT_THAT(meter.events, IsEmpty());
  EXPECT_EQ(meter.track.state().identity, "4711");
  for (int minute = 50; minute <= 80; ++minute)
    meter.read(minutes{minute}, 17.0 + minute, 0.0, 999);
  ASSERT_FALSE(meter.events.empty());
  EXPECT_EQ(meter.events[0].kind, "meter_swapped");
  EXPECT_THAT(meter.events[0].text, HasSubstr("999 instead of 4711"));
  EXPECT_EQ(meter.quarter(0).validity, Validity::ok);
  for (const int quarter : {1, 2, 3}) {
    EXPECT_EQ(meter.quarter(quarter).validity, Validity::missing) << quarter;
  }
  EXPECT_NEAR(meter.quarter(4).mean_kW, 60.0, 1e-9);
}

// step_back_20min: no interval twice, and none with the energy of two.
TEST(MeterTrack, AClockSetBackBooksNothingTwice) {
  Live meter;
  double energy_kWh = 1000.0;
  int given = 0;
  const auto count = [&] { given = static_cast<int>(meter.intervals.size()); };
  for (int minute = 0; minute <= 40; ++minute) meter.read(minutes{minute}, energy_kWh += 1.0);
  count();
  meter.track.clock_was_set();
  for (int minute = 21; minute <= 40; ++minute) meter.read(minutes{minute}, energy_kWh += 1.0);
  EXPECT_EQ(static_cast<int>(meter.intervals.size()), given);
  for (int minute = 41; minute <= 75; ++minute) meter.read(minutes{minute}, energy_kWh += 1.0);
  ASSERT_THAT(meter.intervals, SizeIs(5));
  for (const int quarter : {0, 1, 2, 3, 4}) {
    EXPECT_NEAR(meter.quarter(quarter).mean_kW, 60.0, 1e-9) << quarter;
  }
  EXPECT_THAT(meter.superseding, IsEmpty());
}

// A clock that ran two hours ahead since the boot is put right: what bears stamps of the time to
// come gives way to what is measured then, and nothing waits for the old time to return.
TEST(MeterTrack, StampsOfATimeToComeGiveWay) {
  Live meter;
  double energy_kWh = 1000.0;
  for (int minute = 120; minute <= 160; ++minute) meter.read(minutes{minute}, energy_kWh += 1.0);
  EXPECT_NEAR(meter.quarter(8).mean_kW, 60.0, 1e-9);
  meter.track.clock_was_set();
  for (int minute = 41; minute <= 200; ++minute) meter.read(minutes{minute}, energy_kWh += 2.0);
  for (int quarter = 3; quarter <= 12; ++quarter) {
    EXPECT_NEAR(meter.quarter(quarter).mean_kW, 120.0, 1e-9) << quarter;
  }
  EXPECT_THAT(meter.superseding, Contains(kStart + 8 * kQuarter));
  EXPECT_THAT(meter.superseding, Contains(kStart + 9 * kQuarter));
  EXPECT_THAT(meter.superseding, Not(Contains(kStart + 10 * kQuarter)));
}

// The clock was set back while nobody ran: nobody but the stored register can tell.
TEST(MeterTrack, AStoredRegisterOfATimeToComeBeginsAnew) {
  Live meter;
  double energy_kWh = 1000.0;
  for (int minute = 120; minute <= 160; ++minute) meter.read(minutes{minute}, energy_kWh += 1.0);
  meter.restart();
  for (int minute = 41; minute <= 80; ++minute) meter.read(minutes{minute}, energy_kWh += 1.0);
  EXPECT_NEAR(meter.quarter(3).mean_kW, 60.0, 1e-9);
  EXPECT_NEAR(meter.quarter(4).mean_kW, 60.0, 1e-9);
}

// step_forward_2h: the hours that never were are missing; nothing is spread over them.
TEST(MeterTrack, AClockSetForwardLeavesMissingIntervals) {
  Live meter;
  double energy_kWh = 1000.0;
  for (int minute = 0; minute <= 20; ++minute) meter.read(minutes{minute}, energy_kWh += 1.0);
  meter.track.clock_was_set();
  for (int minute = 141; minute <= 180; ++minute) meter.read(minutes{minute}, energy_kWh += 1.0);
  EXPECT_EQ(meter.quarter(0).validity, Validity::ok);
  for (int quarter = 1; quarter <= 9; ++quarter) {
    EXPECT_EQ(meter.quarter(quarter).validity, Validity::missing) << quarter;
  }
  EXPECT_NEAR(meter.quarter(10).mean_kW, 60.0, 1e-9);
}

TEST(MeterTrack, SamplesOfOneSecondAreOne) {
  Live meter;
  meter.read(seconds{0}, 1000.0);
  meter.read(seconds{0}, 1000.1);
  meter.read(seconds{1}, 1000.1);
  meter.read(kQuarter, 1015.0);
  EXPECT_NEAR(meter.quarter(0).mean_kW, 60.0, 1e-9);
}

// Killed and restarted at any minute, with a reset under way at some of them: same intervals.
TEST(MeterTrack, RestartsChangeNothing) {
  const auto value = [](int minute) { return minute < 20 ? 1000.0 + minute : minute - 20.0; };
  Live steady;
  for (int minute = 0; minute <= 75; ++minute) steady.read(minutes{minute}, value(minute));
  for (int stop = 0; stop <= 74; ++stop) {
    SCOPED_TRACE(stop);
    Live meter;
    for (int minute = 0; minute <= 75; ++minute) {
      meter.read(minutes{minute}, value(minute));
      if (minute == stop) meter.restart();
    }
    ASSERT_EQ(meter.intervals.size(), steady.intervals.size());
    for (const auto& [start, reading] : steady.intervals) {
      const metering::Reading& other = meter.intervals.at(start);
      EXPECT_EQ(other.validity, reading.validity);
      if (reading.validity != Validity::missing) {
        EXPECT_NEAR(other.mean_kW, reading.mean_kW, 1e-9);
      }
    }
  }
}

TEST(MeterTrack, KeepsSamplesAroundBoundariesAndOfDoubt) {
  Live meter;
  for (int minute = 0; minute <= 30; ++minute) {
    meter.read(minutes{minute}, minute == 22 ? 0.0 : 1000.0 + minute);
  }
  std::vector<int> kept;
  for (const RawSample& sample : meter.samples) {
    kept.push_back(static_cast<int>((sample.time - kStart) / minutes{1}));
    EXPECT_EQ(sample.meter, 3u);
  }
  EXPECT_THAT(kept, ElementsAre(0, 14, 15, 22, 23, 29, 30));
}

// stuck: the gateway answers out of its memory, the load goes on.
TEST(MeterTrack, ACounterThatStandsUnderLoadIsDoubted) {
  Live meter;
  for (int minute = 0; minute <= 120; ++minute) {
    meter.read(minutes{minute}, 1000.0 + std::min(minute, 30), 60'000.0);
  }
  ASSERT_THAT(meter.events, SizeIs(1));
  EXPECT_EQ(meter.events[0].kind, "counter_stuck");
  EXPECT_THAT(meter.events[0].text,
              HasSubstr("its counter does not move while its power is 60.0 kW"));
  for (const int quarter : {0, 1}) EXPECT_EQ(meter.quarter(quarter).validity, Validity::ok);
  for (int quarter = 2; quarter < 8; ++quarter) {
    EXPECT_EQ(meter.quarter(quarter).validity, Validity::suspect) << quarter;
    EXPECT_EQ(meter.quarter(quarter).reasons, Reason::stuck);
  }
}

// cross: a transformer that the map multiplies once too often shows in the power alone.
TEST(MeterTrack, APowerThatDiffersFromItsCounterIsTold) {
  Live meter;
  for (int minute = 0; minute <= 24 * 60 + 1; ++minute) {
    meter.read(minutes{minute}, 1000.0 + minute, 66'000.0);
  }
  ASSERT_THAT(meter.events, SizeIs(1));
  EXPECT_EQ(meter.events[0].kind, "power_differs");
  EXPECT_THAT(meter.events[0].text, HasSubstr("adds up to 1.1 times the energy on its counter"));
  EXPECT_EQ(meter.quarter(95).validity, Validity::ok) << "energy is the counter's";
}

constexpr std::string_view kPowerMeter = R"(
source = "the test"
base = 0
power = "power"
register.power = { at = 0, type = "i32", unit = "W", absent = "0x80000000" }
)";

modbus::Words words_of_power(double power_W) {
  const auto bits = static_cast<std::uint32_t>(static_cast<std::int32_t>(power_W));
  return {Live::high(bits), Live::low(bits)};
}

// A device that counts nothing: the mean of its power, and nothing where that was not seen.
TEST(MeterTrack, WithoutACounterThePowerIsAveraged) {
  Live meter{kPowerMeter, 2.0};
  for (seconds t{0}; t <= minutes{60}; t += seconds{15}) {
    if (t > minutes{20} && t < minutes{25}) {
      meter.take(t, tl::unexpected(modbus::ReadFailure{ReadFault::timeout, 0}));
    } else if (t > minutes{35} && t < minutes{37}) {
      meter.take(t, modbus::Words{0x8000, 0});
    } else {
      meter.take(t, words_of_power(t < minutes{45} ? 30'000.0 : 50'000.0));
    }
  }
  ASSERT_THAT(meter.intervals, SizeIs(4));
  EXPECT_NEAR(meter.quarter(0).mean_kW, 60.0, 1e-9);
  EXPECT_EQ(meter.quarter(0).validity, Validity::ok);
  EXPECT_EQ(meter.quarter(1).validity, Validity::missing);
  EXPECT_EQ(meter.quarter(1).reasons, Reason::timeout | Reason::partial);
  EXPECT_EQ(meter.quarter(2).validity, Validity::ok) << "two minutes of absent values";
  EXPECT_NEAR(meter.quarter(3).mean_kW, 100.0, 1e-9);
  EXPECT_FALSE(meter.track.live().register_kWh.has_value());
}

// The open interval is stored every minute: a kill costs that minute and no interval.
TEST(MeterTrack, APowerGoesOnOverARestart) {
  for (int stop = 0; stop <= 75; ++stop) {
    SCOPED_TRACE(stop);
    Live meter{kPowerMeter};
    for (seconds t{0}; t <= minutes{30}; t += seconds{15}) {
      meter.take(t, words_of_power(40'000.0));
      if (t == stop * seconds{15}) meter.restart();
    }
    ASSERT_THAT(meter.intervals, SizeIs(2));
    for (const int quarter : {0, 1}) {
      EXPECT_EQ(meter.quarter(quarter).validity, Validity::ok);
      EXPECT_NEAR(meter.quarter(quarter).mean_kW, 40.0, 1e-9);
    }
  }
}

TEST(MeterTrack, APowerOfATimeToComeGivesWay) {
  Live meter{kPowerMeter};
  for (seconds t = minutes{120}; t <= minutes{140}; t += seconds{15}) {
    meter.take(t, words_of_power(40'000.0));
  }
  meter.track.clock_was_set();
  for (seconds t = minutes{60}; t <= minutes{140}; t += seconds{15}) {
    meter.take(t, words_of_power(20'000.0));
  }
  for (int quarter = 4; quarter <= 8; ++quarter) {
    EXPECT_NEAR(meter.quarter(quarter).mean_kW, 20.0, 1e-9) << quarter;
  }
  EXPECT_THAT(meter.superseding, Contains(kStart + 8 * kQuarter));
  EXPECT_THAT(meter.superseding, Not(Contains(kStart + 9 * kQuarter)));
}

TEST(MeterTrack, APowerKnowsWhenTheClockWasSet) {
  Live meter{kPowerMeter};
  for (seconds t{0}; t <= minutes{20}; t += seconds{15}) meter.take(t, words_of_power(40'000.0));
  meter.track.clock_was_set();
  for (seconds t = minutes{40}; t <= minutes{60}; t += seconds{15}) {
    meter.take(t, words_of_power(40'000.0));
  }
  ASSERT_THAT(meter.intervals, SizeIs(4));
  EXPECT_EQ(meter.quarter(1).reasons, Reason::clock | Reason::partial);
  EXPECT_EQ(meter.quarter(3).validity, Validity::ok);
}

// scale_factor_change: the power of ten belongs to the read that it came with. Energy goes on
// although its digits change, and the register wraps at 2^32 of its present steps.
TEST(MeterTrack, ScaleFactorChange) {
  const auto text = shipped_register_map("sunspec-meter");
  ASSERT_TRUE(text.has_value());
  Live meter{*text};
  const auto read = [&](int minute, std::uint32_t energy, std::uint16_t factor, double power,
                        std::uint16_t power_factor) {
    modbus::Words watts(5);
    watts[0] = static_cast<std::uint16_t>(static_cast<std::int16_t>(power));
    watts[4] = power_factor;
    modbus::Words counter(9);
    counter[0] = Live::high(energy);
    counter[1] = Live::low(energy);
    counter[8] = factor;
    meter.take(minutes{minute}, watts, 0);
    meter.take(minutes{minute}, counter, 1);
  };
  const std::uint16_t minus_one = 0xFFFF;
  for (int minute = 0; minute <= 30; ++minute) {
    // 1000 Wh a minute on 1,000,000 Wh; the load is 60 kW.
    const auto wh = static_cast<std::uint32_t>(1'000'000 + 1000 * minute);
    if (minute < 10) {
      read(minute, wh * 10, minus_one, 6000.0, 1);
    } else {
      read(minute, wh / 100, 2, 600.0, 2);
    }
    EXPECT_NEAR(*meter.track.live().power_kW, 60.0, 1e-9) << minute;
  }
  EXPECT_NEAR(meter.track.state().settings.modulus_kWh, 4'294'967'296.0 * 0.1, 1e-3);
  EXPECT_NEAR(meter.track.state().settings.resolution_kWh, 0.1, 1e-12);
  ASSERT_THAT(meter.intervals, SizeIs(2));
  for (const int quarter : {0, 1}) {
    EXPECT_EQ(meter.quarter(quarter).validity, Validity::ok);
    EXPECT_NEAR(meter.quarter(quarter).mean_kW, 60.0, 1e-9) << quarter;
  }
  EXPECT_THAT(meter.events, IsEmpty());

  // An accumulator of 0 does not count, and a factor of 0x8000 is none: nothing is booked.
  read(31, 0, 2, 600.0, 0x8000);
  read(32, 10'320, 0x8000, 600.0, 2);
  EXPECT_EQ(meter.track.state().counter.phase, metering::CounterPhase::run);
  read(33, 10'330, 2, 600.0, 2);
  EXPECT_EQ(meter.track.state().counter.baseline.value_kWh, 1033.0);
}

// Two tariffs are summed, of one poll only: half a sum is none.
TEST(MeterTrack, TariffsAreSummed) {
  constexpr std::string_view tariffs = R"(
source = "the test"
base = 0
energy = ["t1", "t2"]
register.t1 = { at = 0, type = "u32", unit = "Wh" }
register.t2 = { at = 100, type = "u32", unit = "Wh" }
)";
  Live meter{tariffs};
  const auto words = [](int wh) {
    const auto bits = static_cast<std::uint32_t>(wh);
    return modbus::Words{Live::high(bits), Live::low(bits)};
  };
  for (int minute = 0; minute <= 15; ++minute) {
    // Of the fifth poll the second read failed, of the sixth the first.
    if (minute != 6) meter.take(minutes{minute}, words(1'000'000 + 500 * minute), 0);
    if (minute != 5) meter.take(minutes{minute}, words(2'000'000 + 500 * minute), 1);
    if (minute == 6) {
      EXPECT_NEAR(*meter.track.live().register_kWh, 3004.0, 1e-9);
    }
  }
  EXPECT_NEAR(meter.quarter(0).mean_kW, 60.0, 1e-9);
  EXPECT_EQ(meter.quarter(0).validity, Validity::ok);
  EXPECT_NEAR(*meter.track.live().register_kWh, 3015.0, 1e-9);
  EXPECT_FALSE(meter.track.live().power_kW.has_value());
}

}  // namespace
}  // namespace recald::daemon::meter_track_test
