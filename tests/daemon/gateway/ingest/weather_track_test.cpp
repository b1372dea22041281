/// One weather sensor: register contents become interval means, and what cannot be is told.
#include "daemon/gateway/ingest/weather_track.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "adapters/sqlite/tables/register_json.hpp"
#include "daemon/site/config/register_map_file.hpp"
#include "tests/daemon/gateway/weather_station.hpp"

namespace recald::daemon::weather_track_test {
namespace {

using metering::Instant;
using metering::Validity;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using testing::station_registers;
using weather::WeatherHour;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};

class WeatherTrackTest : public ::testing::Test {
 protected:
  WeatherTrackTest() { begin(); }

  /// As a process does: with what was stored last.
  void begin() {
    TrackedSensor sensor{.id = "roof",
                         .map = map_,
                         .averaging = {.interval = minutes{15}, .sample_gap_max = seconds{120}},
                         .quantities = {}};
    for (std::uint32_t i = 0; i < weather::kSensorQuantities.size(); ++i) {
      TrackedQuantity tracked{.number = i, .quantity = &weather::kSensorQuantities.at(i)};
      for (const auto& [key, json] : stored_) {
        if (key.first != i) continue;
        tracked.restored.push_back(sqlite::register_from_json(json).value());
      }
      sensor.quantities.push_back(std::move(tracked));
    }
    track_.emplace(std::move(sensor));
  }

  void keep(const StoreBatch& batch) {
    for (const auto& interval : batch.intervals) intervals_.push_back(interval);
    for (const auto& event : batch.events) events_.push_back(event);
    for (const auto& entry : batch.registers) {
      stored_[{entry.meter, entry.state.field}] = sqlite::to_json(entry.state);
    }
  }

  void poll(const WeatherHour& now, Instant at) {
    keep(track_->take(reads_.front(), station_registers(now), at));
  }
  /// Each minute up to and including `until`.
  void poll_until(Instant until, const std::function<WeatherHour(double hours)>& weather) {
    for (; at_ <= until; at_ += minutes{1}) poll(weather(metering::in_hours(at_ - kStart)), at_);
  }

  std::vector<metering::Reading> means(std::uint32_t number) const {
    std::vector<metering::Reading> all;
    for (const auto& interval : intervals_) {
      if (interval.reading.meter == number) all.push_back(interval.reading);
    }
    return all;
  }

  modbus::RegisterMap map_ = parse_register_map(testing::kStationMap, "station").value().map;
  std::vector<modbus::PlannedRead> reads_ =
      plan_reads(metered_fields(map_), map_.function, map_.limits).value();
  std::optional<WeatherTrack> track_;
  std::map<std::pair<std::uint32_t, std::string>, std::string> stored_;
  std::vector<StoreBatch::Interval> intervals_;
  std::vector<StoreEvent> events_;
  Instant at_ = kStart;
};

TEST_F(WeatherTrackTest, IntervalsAreMeansOfTheValues) {
  ASSERT_THAT(reads_, SizeIs(1));
  poll_until(kStart + hours{24}, testing::usual_weather);
  const auto dry_bulb = means(0);
  ASSERT_THAT(dry_bulb, SizeIs(96));
  for (const metering::Reading& one : dry_bulb) {
    EXPECT_EQ(one.validity, Validity::ok);
    const double middle_h = metering::in_hours(one.start - kStart) + 0.125;
    EXPECT_NEAR(one.mean_kW, testing::usual_weather(middle_h).dry_bulb_C, 0.06);
  }
  EXPECT_THAT(means(4), SizeIs(96));
  EXPECT_NEAR(track_->now(0).value(), testing::usual_weather(24.0).dry_bulb_C, 0.06);
  EXPECT_EQ(track_->read_at(), kStart + hours{24});
}

// Between 350 and 10 degrees lies north, not south.
TEST_F(WeatherTrackTest, WindThatTurnsThroughNorthComesFromThere) {
  poll_until(kStart + minutes{15}, [](double h) {
    WeatherHour now = testing::usual_weather(h);
    now.wind_dir_deg = std::lround(60.0 * h) % 2 == 0 ? 350.0 : 14.0;
    return now;
  });
  ASSERT_THAT(means(3), SizeIs(1));
  EXPECT_NEAR(means(3)[0].mean_kW, 2.0, 0.01);
}

TEST_F(WeatherTrackTest, AQuantityWithoutAValueCostsTheOthersNothing) {
  poll_until(kStart + hours{1}, [](double h) {
    WeatherHour now = testing::usual_weather(h);
    if (h > 0.2 && h < 0.6) now.ghi_W_m2 = kAbsent;
    return now;
  });
  ASSERT_THAT(means(0), SizeIs(4));
  ASSERT_THAT(means(4), SizeIs(4));
  EXPECT_EQ(means(0)[1].validity, Validity::ok);
  EXPECT_EQ(means(4)[1].validity, Validity::missing);
  EXPECT_TRUE(metering::has(means(4)[1].reasons, metering::Reason::sentinel));
  EXPECT_EQ(means(4)[3].validity, Validity::ok);
}

// 85 degrees is what a thermometer without contact shows.
TEST_F(WeatherTrackTest, AValueThatCannotBeIsNoneAndToldOnceAnHour) {
  poll_until(kStart + hours{1}, testing::usual_weather);
  intervals_.clear();
  poll_until(kStart + hours{3} + minutes{30}, [](double h) {
    WeatherHour now = testing::usual_weather(h);
    now.dry_bulb_C = 85.0;
    return now;
  });
  EXPECT_FALSE(track_->now(0).has_value());
  EXPECT_THAT(means(1), SizeIs(10));
  ASSERT_THAT(events_, SizeIs(3));
  EXPECT_EQ(events_[0].kind, "weather_not_plausible");
  EXPECT_EQ(events_[0].subject, "roof");
  EXPECT_TRUE(events_[0].is_counted);
  EXPECT_THAT(events_[0].text,
              HasSubstr("85 degC cannot be dry_bulb_C, which lies between -60 and 60"));
  poll_until(kStart + hours{4}, testing::usual_weather);
  const auto dry_bulb = means(0);  // what was missing is known when a value comes again
  ASSERT_THAT(dry_bulb, SizeIs(12));
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(dry_bulb[i].validity, Validity::missing) << i;
  EXPECT_EQ(dry_bulb.back().validity, Validity::ok);
}

// A process that ends at any minute and begins again gives the same intervals.
TEST_F(WeatherTrackTest, RestartsChangeNothing) {
  poll_until(kStart + hours{2}, testing::usual_weather);
  const auto whole = intervals_;
  for (int restart = 1; restart < 40; ++restart) {
    SCOPED_TRACE(restart);
    stored_.clear();
    intervals_.clear();
    at_ = kStart;
    begin();
    poll_until(kStart + minutes{restart}, testing::usual_weather);
    begin();
    poll_until(kStart + hours{2}, testing::usual_weather);
    ASSERT_EQ(intervals_.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(intervals_[i].reading.start, whole[i].reading.start);
      EXPECT_NEAR(intervals_[i].reading.mean_kW, whole[i].reading.mean_kW, 1e-9);
    }
  }
}

// A component of the wind that a damaged store has lost leaves no half of a direction.
TEST_F(WeatherTrackTest, HalfOfADirectionBeginsAnew) {
  poll_until(kStart + minutes{20}, testing::usual_weather);
  stored_.erase({3, "north"});
  intervals_.clear();
  begin();
  poll_until(kStart + hours{1}, testing::usual_weather);
  ASSERT_FALSE(means(3).empty());
  for (const auto& one : means(3)) {
    const double middle_h = metering::in_hours(one.start - kStart) + 0.125;
    if (one.validity != Validity::ok) continue;
    EXPECT_NEAR(one.mean_kW, testing::usual_weather(middle_h).wind_dir_deg, 0.5);
  }
}

// A sensor that was silent for two months does not leave thousands of rows in one commit.
TEST_F(WeatherTrackTest, ALongSilenceLeavesNoIntervals) {
  poll_until(kStart + hours{1}, testing::usual_weather);
  intervals_.clear();
  at_ += hours{24 * 60};
  poll_until(at_ + minutes{30}, testing::usual_weather);
  EXPECT_LE(intervals_.size(), 15U);
  EXPECT_EQ(means(0).back().validity, Validity::ok);
  at_ += hours{2};
  intervals_.clear();
  poll_until(at_ + minutes{30}, testing::usual_weather);
  EXPECT_GE(std::ranges::count(means(0), Validity::missing, &metering::Reading::validity), 7);
}

TEST_F(WeatherTrackTest, AClockSetBackGivesTheHourAnew) {
  poll_until(kStart + hours{3}, testing::usual_weather);
  intervals_.clear();
  at_ = kStart + hours{1} + minutes{5};
  track_->clock_was_set();
  poll_until(kStart + hours{3}, [](double) { return testing::usual_weather(12.0); });
  std::set<Instant> starts;
  for (const auto& interval : intervals_) {
    if (interval.reading.meter != 0 || interval.reading.validity != Validity::ok) continue;
    EXPECT_TRUE(interval.supersedes) << metering::to_string(interval.reading.start);
    EXPECT_NEAR(interval.reading.mean_kW, testing::usual_weather(12.0).dry_bulb_C, 0.06);
    starts.insert(interval.reading.start);
  }
  EXPECT_THAT(starts, SizeIs(7));  // from a quarter past one on
}

}  // namespace
}  // namespace recald::daemon::weather_track_test
