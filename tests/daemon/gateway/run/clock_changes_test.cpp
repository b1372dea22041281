/// The gateway through clock changes on a virtual clock: months of 92- and 100-slot days, half-hour
/// changes, days without midnight, years that turn at another time than UTC's, clocks set by a day.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/daemon/gateway/gateway_rig.hpp"

namespace recald::daemon::clock_changes_test {
namespace {

using metering::Instant;
using metering::Month;
using metering::MonthlyFigure;
using metering::TimeSpan;
using metering::Validity;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::Contains;
using ::testing::Field;
using ::testing::Not;

// Two registers of 0.1 kWh bound an energy, so a sum is known to within that.
constexpr double kTick = 0.1 + 1e-6;

Instant utc(int year, unsigned month, unsigned day, int hour = 0) {
  return std::chrono::sys_days{std::chrono::year{year} / std::chrono::month{month} /
                               std::chrono::day{day}} +
         hours{hour};
}

/// A gateway with one meter in some zone, from some time on.
class GatewayInZone : private testing::RigInMemory {
 public:
  /// @param is_trial  Its time is that of a recording.
  GatewayInZone(const std::string& zone, Instant start, bool is_trial = false)
      : RigInMemory{start}, start_{start} {
    if (is_trial) clock_.reset();
    begin(load(testing::site_head(zone, "watermark = \"2h\"\n") + testing::kMainMeter));
  }

  void run_until(Instant t) { loop_.run_for(t - loop_.now().wall); }
  void set_clock(milliseconds forward) { loop_.set_wall_clock(forward); }
  /// The latest of a month.
  [[nodiscard]] const MonthlyFigure& figure(Month month) const { return last(month).figure; }
  [[nodiscard]] Instant closed_at(Month month) const { return last(month).at; }

  /// What the device counted in a span, as long as nobody has set the clock.
  [[nodiscard]] double true_kWh(const TimeSpan& span) const {
    return testing::main_kWh(span.end - start_) - testing::main_kWh(span.begin - start_);
  }

  struct Stored {
    int slots = 0;
    int ok = 0;
    int missing = 0;
    double energy_kWh = 0.0;  ///< Of those that are ok.
  };
  Stored stored(const TimeSpan& span) {
    Stored sum;
    for (const metering::Reading& reading : RigInMemory::stored("main", span)) {
      ++sum.slots;
      sum.missing += static_cast<int>(reading.validity == Validity::missing);
      if (reading.validity != Validity::ok) continue;
      ++sum.ok;
      sum.energy_kWh += reading.mean_kW * 0.25;
    }
    return sum;
  }
  std::vector<StoreEvent> events() { return store_.events(100).value(); }

 private:
  [[nodiscard]] const ClosedMonth& last(Month month) const {
    return *std::find_if(closed_.rbegin(), closed_.rend(),
                         [&](const ClosedMonth& one) { return one.figure.month == month; });
  }

  Instant start_;
};

struct ChangeMonth {
  const char* name;  ///< Of the golden case, and which.
  const char* zone;
  Month month;
  unsigned change_day;
  int day_slots;
  int month_slots;
};

void PrintTo(const ChangeMonth& change, std::ostream* out) { *out << change.name; }

class ClockChange : public ::testing::TestWithParam<ChangeMonth> {};

// Every slot of the month is measured, the day of the change has those that it lasts, and the
// month's energy is what the device counted between its local midnights.
TEST_P(ClockChange, MonthIsWholeAndItsEnergyTrue) {
  const ChangeMonth& change = GetParam();
  const auto calendar = metering::LocalCalendar::open(change.zone).value();
  const TimeSpan month = calendar.month_span(change.month);
  GatewayInZone gateway{change.zone, month.begin - hours{30}};
  gateway.run_until(month.end + hours{4});
  const MonthlyFigure& figure = gateway.figure(change.month);
  EXPECT_EQ(figure.slots, change.month_slots);
  EXPECT_EQ(figure.coverage, 1.0);
  EXPECT_NEAR(figure.daily_average_kWh * metering::days_in(change.month), gateway.true_kWh(month),
              kTick);
  const auto stored = gateway.stored(month);
  EXPECT_EQ(stored.ok, change.month_slots);
  EXPECT_EQ(stored.slots, change.month_slots);
  const TimeSpan day = calendar.day_span(change.month / std::chrono::day{change.change_day});
  EXPECT_EQ(gateway.stored(day).ok, change.day_slots);
  EXPECT_NEAR(gateway.stored(day).energy_kWh, gateway.true_kWh(day), kTick);
}

constexpr auto k2024 = std::chrono::year{2024};
constexpr auto k2040 = std::chrono::year{2040};
INSTANTIATE_TEST_SUITE_P(
    Golden, ClockChange,
    ::testing::Values(
        ChangeMonth{"month_92_100_slots_spring", "America/Chicago", k2024 / 3, 10, 92, 31 * 96 - 4},
        ChangeMonth{"month_92_100_slots_autumn", "America/Chicago", k2024 / 11, 3, 100,
                    30 * 96 + 4},
        ChangeMonth{"lord_howe_94_98_spring", "Australia/Lord_Howe", k2024 / 10, 6, 94,
                    31 * 96 - 2},
        ChangeMonth{"lord_howe_94_98_autumn", "Australia/Lord_Howe", k2024 / 4, 7, 98, 30 * 96 + 2},
        ChangeMonth{"midnight_missing", "Africa/Cairo", k2024 / 4, 26, 92, 30 * 96 - 4},
        ChangeMonth{"quarter_hour_offset", "Pacific/Chatham", k2024 / 9, 29, 92, 30 * 96 - 4},
        // After what zone files list, by the rules at their ends.
        ChangeMonth{"rule_spring", "Europe/Berlin", k2040 / 3, 25, 92, 31 * 96 - 4},
        ChangeMonth{"rule_autumn", "America/Chicago", k2040 / 11, 4, 100, 30 * 96 + 4},
        ChangeMonth{"rule_lord_howe", "Australia/Lord_Howe", k2040 / 4, 1, 98, 30 * 96 + 2},
        ChangeMonth{"rule_negative_summer_time", "Europe/Dublin", k2040 / 10, 28, 100, 31 * 96 + 4},
        ChangeMonth{"rule_day_before", "America/Nuuk", k2040 / 3, 24, 92, 31 * 96 - 4}),
    [](const auto& change) { return change.param.name; });

// In Tokyo the year begins at 15:00 of UTC's last day.
TEST(GatewayClock, YearBoundaryUtc) {
  GatewayInZone gateway{"Asia/Tokyo", utc(2024, 11, 30)};
  const Month december = std::chrono::year{2024} / 12;
  const Month january = std::chrono::year{2025} / 1;
  gateway.run_until(utc(2025, 1, 31, 20));
  const TimeSpan months[] = {{utc(2024, 11, 30, 15), utc(2024, 12, 31, 15)},
                             {utc(2024, 12, 31, 15), utc(2025, 1, 31, 15)}};
  EXPECT_NEAR(gateway.figure(december).daily_average_kWh * 31.0, gateway.true_kWh(months[0]),
              kTick);
  EXPECT_NEAR(gateway.figure(january).daily_average_kWh * 31.0, gateway.true_kWh(months[1]), kTick);
  EXPECT_EQ(gateway.figure(december).coverage, 1.0);
  EXPECT_GE(gateway.closed_at(december), months[0].end + hours{2});
  EXPECT_LE(gateway.closed_at(december), months[0].end + hours{3});
}

// Long before recald was made: the clock of a trial is that of the recording.
TEST(GatewayClock, AnOldRecordingIsReplayed) {
  for (const auto year : {std::chrono::year{1998}, std::chrono::year{2015}}) {
    const Month march = year / 3;
    const TimeSpan month =
        metering::LocalCalendar::open("America/Chicago").value().month_span(march);
    GatewayInZone gateway{"America/Chicago", month.begin - hours{30}, true};
    gateway.run_until(month.end + hours{4});
    EXPECT_EQ(gateway.figure(march).coverage, 1.0);
    EXPECT_NEAR(gateway.figure(march).daily_average_kWh * 31.0, gateway.true_kWh(month), kTick);
  }
}

// Without a time server nothing bears the stamp of a leap by decades, and the clock's way back is
// a step like any other.
TEST(GatewayClock, ALeapByDecadesIsHeldAndSaid) {
  GatewayInZone gateway{"America/Chicago", utc(2024, 5, 1)};
  gateway.run_until(utc(2024, 5, 3, 6) + minutes{5});
  const milliseconds leap = utc(2106, 2, 7, 6) - utc(2024, 5, 3, 6);
  gateway.set_clock(leap);
  gateway.run_until(utc(2106, 2, 7, 8));
  EXPECT_EQ(gateway.stored({utc(2024, 5, 4), Instant::max()}).slots, 0);
  EXPECT_THAT(
      gateway.events(),
      Contains(::testing::AllOf(
          Field(&StoreEvent::kind, "clock_set"), Field(&StoreEvent::severity, Severity::error),
          Field(&StoreEvent::time, ::testing::Lt(utc(2024, 5, 3, 7))),
          Field(&StoreEvent::text, ::testing::HasSubstr("readings are held")))));
  gateway.set_clock(-leap);
  gateway.run_until(utc(2024, 5, 7));
  EXPECT_EQ(gateway.stored({utc(2024, 5, 2), utc(2024, 5, 3)}).ok, 96);
  EXPECT_EQ(gateway.stored({utc(2024, 5, 4), utc(2024, 5, 6)}).ok, 2 * 96);
  EXPECT_EQ(gateway.stored({utc(2024, 5, 8), Instant::max()}).slots, 0);
}

// A day is lived through a second time: what was measured the first time stays, nothing is there
// twice, and the days after it are whole.
TEST(GatewayClock, StepBackADay) {
  GatewayInZone gateway{"America/Chicago", utc(2024, 5, 1)};
  gateway.run_until(utc(2024, 5, 4, 6) + minutes{5});
  const TimeSpan lived{utc(2024, 5, 3, 7), utc(2024, 5, 4, 6)};
  const auto before = gateway.stored(lived);
  EXPECT_EQ(before.ok, 23 * 4);
  gateway.set_clock(-days{1});
  gateway.run_until(utc(2024, 5, 7));
  const auto after = gateway.stored(lived);
  EXPECT_EQ(after.slots, 23 * 4);
  EXPECT_EQ(after.ok, before.ok);
  EXPECT_NEAR(after.energy_kWh, before.energy_kWh, 1e-9);
  EXPECT_EQ(gateway.stored({utc(2024, 5, 5), utc(2024, 5, 6)}).ok, 96);
  EXPECT_THAT(gateway.events(), Contains(Field(&StoreEvent::kind, "clock_set")));
  EXPECT_THAT(gateway.events(), Not(Contains(Field(&StoreEvent::kind, "counter_jump"))));
}

// A day that never was is missing, whole and alone.
TEST(GatewayClock, StepForwardADay) {
  GatewayInZone gateway{"America/Chicago", utc(2024, 5, 1)};
  gateway.run_until(utc(2024, 5, 3, 6) + minutes{5});
  gateway.set_clock(days{1});
  gateway.run_until(utc(2024, 5, 7));
  const auto skipped = gateway.stored({utc(2024, 5, 3, 6), utc(2024, 5, 4, 6)});
  EXPECT_EQ(skipped.ok, 0);
  EXPECT_GE(skipped.missing, 95);
  EXPECT_EQ(gateway.stored({utc(2024, 5, 2), utc(2024, 5, 3)}).ok, 96);
  const TimeSpan day_after{utc(2024, 5, 5), utc(2024, 5, 6)};
  EXPECT_EQ(gateway.stored(day_after).ok, 96);
  // The device lives a day less than the clock says.
  EXPECT_NEAR(gateway.stored(day_after).energy_kWh,
              gateway.true_kWh({day_after.begin - days{1}, day_after.end - days{1}}), kTick);
  EXPECT_THAT(gateway.events(), Contains(Field(&StoreEvent::kind, "clock_set")));
  EXPECT_THAT(gateway.events(), Not(Contains(Field(&StoreEvent::kind, "counter_jump"))));
}

}  // namespace
}  // namespace recald::daemon::clock_changes_test
