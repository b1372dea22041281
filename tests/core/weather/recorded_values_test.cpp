#include "core/weather/recorded_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace recald::weather::recorded_values_test {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2021} / 4 / 1};
constexpr int kDays = 180;

/// Air near the ground, minute by minute: it follows the sun between passing clouds and mixes with
/// the air above, which has its own course and noise.
struct Minutes {
  std::vector<double> dry_bulb_C;
  std::vector<double> ghi_W_m2;
};

Minutes outdoors(unsigned seed, double sun_K_per_kW, double delay_min = 40.0) {
  std::mt19937 random{seed};
  std::normal_distribution<double> normal;
  Minutes made;
  double cloud = 0.0;
  double above_C = 10.0;
  double near_K = 0.0;
  for (int minute = 0; minute <= kDays * 1440; ++minute) {
    const double angle = (minute % 1440) / 1440.0 * 2.0 * std::numbers::pi;
    cloud += -cloud / 90.0 + 0.12 * normal(random);
    above_C += (10.0 - above_C) / 4000.0 + 0.03 * normal(random);
    const double clear_W_m2 = std::max(0.0, -800.0 * std::cos(angle));
    made.ghi_W_m2.push_back(clear_W_m2 * std::clamp(0.6 - 0.4 * cloud, 0.1, 1.0));
    near_K += (sun_K_per_kW * made.ghi_W_m2.back() / 1000.0 - near_K) / delay_min;
    made.dry_bulb_C.push_back(above_C + near_K);
  }
  return made;
}

/// The station's file: one record an hour.
std::vector<WeatherRecord> recorded(const Minutes& minutes_of, ValuesStand stand) {
  std::vector<WeatherRecord> records;
  for (int hour = 0; hour < kDays * 24; ++hour) {
    const auto begin = static_cast<std::ptrdiff_t>(hour) * 60;
    const auto mean = [&](const std::vector<double>& values) {
      double sum = 0.0;
      for (std::ptrdiff_t i = begin; i < begin + 60; ++i)
        sum += values[static_cast<std::size_t>(i)];
      return sum / 60.0;
    };
    const auto at = static_cast<std::size_t>(stand == ValuesStand::at_its_end ? begin + 60 : begin);
    WeatherRecord record{kStart + hours{hour}, {}};
    record.values.dry_bulb_C = stand == ValuesStand::over_the_record ? mean(minutes_of.dry_bulb_C)
                                                                     : minutes_of.dry_bulb_C[at];
    record.values.ghi_W_m2 = mean(minutes_of.ghi_W_m2);
    records.push_back(record);
  }
  return records;
}

TEST(ValuesByTheSun, InstantsAndMeansAreToldApart) {
  unsigned seed = 0;
  for (const double delay_min : {20.0, 40.0, 75.0, 150.0}) {
    SCOPED_TRACE(delay_min);
    const Minutes weather = outdoors(++seed, 6.0, delay_min);
    for (const ValuesStand end : {ValuesStand::at_its_start, ValuesStand::at_its_end}) {
      EXPECT_EQ(values_by_the_sun(recorded(weather, end), hours{1}, end), RecordedValues::instant);
      EXPECT_EQ(values_by_the_sun(recorded(weather, ValuesStand::over_the_record), hours{1}, end),
                RecordedValues::mean);
    }
  }
}

TEST(ValuesByTheSun, ARecordThatCannotTellSaysNothing) {
  const auto end = ValuesStand::at_its_end;
  EXPECT_EQ(values_by_the_sun(recorded(outdoors(1, 0.0), end), hours{1}, end), std::nullopt);
  auto dark = recorded(outdoors(1, 6.0), end);
  for (WeatherRecord& record : dark) record.values.ghi_W_m2 = kAbsent;
  EXPECT_EQ(values_by_the_sun(dark, hours{1}, end), std::nullopt);
  const auto all = recorded(outdoors(1, 6.0), end);
  EXPECT_EQ(values_by_the_sun(std::span{all}.first(240), hours{1}, end), std::nullopt);
  EXPECT_EQ(values_by_the_sun({}, hours{1}, end), std::nullopt);
}

TEST(ValuesTaken, InWords) {
  EXPECT_EQ(to_string({RecordedValues::instant, KnownBy::inferred}), "instant (inferred)");
  EXPECT_EQ(to_string({RecordedValues::mean, KnownBy::declared}), "mean (declared)");
  EXPECT_EQ(to_string({RecordedValues::mean, KnownBy::usage}), "mean (default)");
}

/// 10 °C at the start, 1 K more each hour; the sun shines 100 W/m² more each hour.
std::vector<WeatherRecord> ramp(seconds step, ValuesStand stand, int count) {
  std::vector<WeatherRecord> records;
  for (int i = 0; i < count; ++i) {
    const Instant start = kStart + i * step;
    const Instant at = stand == ValuesStand::at_its_end ? start + step : start;
    WeatherRecord record{start, {}};
    record.values.dry_bulb_C = 10.0 + metering::in_hours(at - kStart);
    record.values.wind_speed_m_s = 2.0;
    record.values.wind_dir_deg = i % 2 == 0 ? 350.0 : 10.0;
    record.values.ghi_W_m2 = 100.0 * (metering::in_hours(start - kStart) + 1.0);
    records.push_back(record);
  }
  return records;
}

// Whatever the step and the stamp, the mean over the hour from 01:00 of a temperature that rises
// from 11 to 12 °C is 11.5 °C; the sun is the record's own.
TEST(ToHourlyOfInstants, IsTheMeanBetweenThem) {
  for (const seconds step : {seconds{900}, seconds{1800}, seconds{3600}}) {
    for (const ValuesStand stand : {ValuesStand::at_its_start, ValuesStand::at_its_end}) {
      const auto series =
          to_hourly(ramp(step, stand, 3 * 3600 / static_cast<int>(step.count())), step, stand);
      ASSERT_TRUE(series.has_value());
      EXPECT_NEAR(series->hours.at(1).dry_bulb_C, 11.5, 1e-9) << step.count();
      EXPECT_NEAR(std::remainder(series->hours.at(1).wind_dir_deg, 360.0), 0.0, 1e-9);
      const double sun_W_m2 = 250.0 - metering::in_hours(step) * 50.0;
      EXPECT_NEAR(series->hours.at(1).ghi_W_m2, sun_W_m2, 1e-9) << step.count();
    }
  }
}

// Airports report at 53 minutes past: the line between two reports is what the hour's mean is of.
TEST(ToHourlyOfInstants, OffTheHourToo) {
  for (const ValuesStand stand : {ValuesStand::at_its_start, ValuesStand::at_its_end}) {
    auto records = ramp(hours{1}, stand, 4);
    for (WeatherRecord& record : records) record.start += minutes{53};
    // A bend at 02:53, or it would not matter which end of a record its instant is at.
    records[stand == ValuesStand::at_its_end ? 2 : 3].values.dry_bulb_C += 60.0;
    const auto series = to_hourly(records, hours{1}, stand);
    const double bend_K = 7.0 / 60.0 * 3.5;
    EXPECT_NEAR(series->hours.at(2).dry_bulb_C, 10.0 + 2.5 - 53.0 / 60.0 + bend_K, 1e-9);
  }
}

// Beside a hole, and at the ends of the record, an instant stands for its interval: as many hours
// are known as were recorded.
TEST(ToHourlyOfInstants, AHoleCostsNoMoreThanItself) {
  for (const ValuesStand stand : {ValuesStand::at_its_start, ValuesStand::at_its_end}) {
    auto records = ramp(hours{1}, stand, 8);
    records[2].values.dry_bulb_C = kAbsent;
    records.erase(records.begin() + 5);
    const auto series = to_hourly(records, hours{1}, stand);
    const auto known = std::ranges::count_if(
        series->hours, [](const WeatherHour& hour) { return std::isfinite(hour.dry_bulb_C); });
    EXPECT_EQ(known, 6);
    EXPECT_TRUE(std::isnan(series->hours.at(2).dry_bulb_C));
    EXPECT_TRUE(std::isfinite(series->hours.at(2).ghi_W_m2));
    EXPECT_TRUE(std::isnan(series->hours.at(5).dry_bulb_C));
    const std::size_t alone = stand == ValuesStand::at_its_end ? 3 : 1;
    EXPECT_NEAR(series->hours.at(alone).dry_bulb_C, records[alone].values.dry_bulb_C, 1e-9);
    // The hour beside the row that is not there; what lies behind it is no neighbour.
    const std::size_t beside = stand == ValuesStand::at_its_end ? 6 : 4;
    const std::size_t row = stand == ValuesStand::at_its_end ? 5 : 4;
    EXPECT_NEAR(series->hours.at(beside).dry_bulb_C, records[row].values.dry_bulb_C, 1e-9);
  }
}

}  // namespace
}  // namespace recald::weather::recorded_values_test
