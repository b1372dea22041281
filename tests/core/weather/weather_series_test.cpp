#include "core/weather/weather_series.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::weather {
namespace {

using metering::LocalCalendar;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2016} / 5 / 1};

WeatherRecord dry_bulb(Instant start, double value_C) {
  WeatherRecord record{start, {}};
  record.values.dry_bulb_C = value_C;
  return record;
}

WeatherRecord wind(Instant start, double speed_m_s, double direction_deg) {
  WeatherRecord record{start, {}};
  record.values.wind_speed_m_s = speed_m_s;
  record.values.wind_dir_deg = direction_deg;
  return record;
}

LocalCalendar calendar(const char* zone) { return *LocalCalendar::open(zone); }

TEST(ToHourly, QuarterHoursAreAveraged) {
  std::vector<WeatherRecord> records;
  for (int i = 0; i < 8; ++i) records.push_back(dry_bulb(kStart + minutes{15 * i}, i));
  const auto series = to_hourly(records, minutes{15});
  ASSERT_TRUE(series.has_value());
  EXPECT_EQ(series->begin, kStart);
  ASSERT_EQ(series->hours.size(), 2u);
  EXPECT_DOUBLE_EQ(series->hours[0].dry_bulb_C, 1.5);
  EXPECT_DOUBLE_EQ(series->hours[1].dry_bulb_C, 5.5);
  EXPECT_TRUE(std::isnan(series->hours[0].ghi_W_m2));
}

TEST(ToHourly, LessThanHalfAnHourIsAbsent) {
  const std::vector<WeatherRecord> records{dry_bulb(kStart, 1.0), dry_bulb(kStart + hours{1}, 4.0),
                                           dry_bulb(kStart + minutes{75}, 6.0)};
  const auto series = to_hourly(records, minutes{15});
  ASSERT_TRUE(series.has_value());
  EXPECT_TRUE(std::isnan(series->hours[0].dry_bulb_C));
  EXPECT_DOUBLE_EQ(series->hours[1].dry_bulb_C, 5.0);
}

// An hourly station at UTC+5:30 starts its hours half past: each hour of UTC is half of two.
TEST(ToHourly, HalfHourZonesAreWeightedByOverlap) {
  const std::vector<WeatherRecord> records{dry_bulb(kStart + minutes{30}, 10.0),
                                           dry_bulb(kStart + minutes{90}, 20.0)};
  const auto series = to_hourly(records, hours{1});
  ASSERT_TRUE(series.has_value());
  ASSERT_EQ(series->hours.size(), 3u);
  EXPECT_DOUBLE_EQ(series->hours[0].dry_bulb_C, 10.0);
  EXPECT_DOUBLE_EQ(series->hours[1].dry_bulb_C, 15.0);
  EXPECT_DOUBLE_EQ(series->hours[2].dry_bulb_C, 20.0);
}

TEST(ToHourly, WindFromBothSidesOfNorthIsANorthWind) {
  const std::vector<WeatherRecord> records{wind(kStart, 3.0, 350.0),
                                           wind(kStart + minutes{30}, 3.0, 10.0)};
  const auto series = to_hourly(records, minutes{30});
  ASSERT_TRUE(series.has_value());
  EXPECT_NEAR(std::remainder(series->hours[0].wind_dir_deg, 360.0), 0.0, 1e-9);
  EXPECT_DOUBLE_EQ(series->hours[0].wind_speed_m_s, 3.0);
}

// 4 m/s from the east and 3 m/s from the south: the mean vector points to 90° + atan(3/4).
TEST(ToHourly, StrongerWindCountsMore) {
  const std::vector<WeatherRecord> records{wind(kStart, 4.0, 90.0),
                                           wind(kStart + minutes{30}, 3.0, 180.0)};
  const auto series = to_hourly(records, minutes{30});
  EXPECT_NEAR(series->hours[0].wind_dir_deg, 126.8698976, 1e-6);
}

TEST(ToHourly, OrderAndRepetitionsDoNotMatter) {
  const std::vector<WeatherRecord> records{dry_bulb(kStart + hours{2}, 3.0), dry_bulb(kStart, 1.0),
                                           dry_bulb(kStart, 99.0),
                                           dry_bulb(kStart + hours{1}, 2.0)};
  const auto series = to_hourly(records, hours{1});
  ASSERT_EQ(series->hours.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(series->hours[i].dry_bulb_C, 1.0 + static_cast<double>(i));
}

TEST(ToHourly, ThreeHourlyObservationsLeaveGapsToFill) {
  const std::vector<WeatherRecord> records{dry_bulb(kStart, 3.0), dry_bulb(kStart + hours{3}, 9.0)};
  const auto series = to_hourly(records, hours{3});
  ASSERT_EQ(series->hours.size(), 4u);
  EXPECT_TRUE(std::isnan(series->hours[1].dry_bulb_C));
  const FilledWeather filled = fill_gaps(*series, calendar("UTC"));
  EXPECT_DOUBLE_EQ(filled.series.find(kStart + hours{1})->dry_bulb_C, 5.0);
}

TEST(ToHourly, NothingIsAnError) {
  EXPECT_EQ(to_hourly({}, hours{1}).error().code, ErrorCode::not_enough_data);
}

/// May 2016 in UTC: the hour of the day as temperature, `absent` hours left out.
template <class Absent>
WeatherSeries may_without(Absent absent) {
  WeatherSeries series{kStart, std::vector<WeatherHour>(744)};
  for (int i = 0; i < 744; ++i) {
    if (!absent(i)) series.hours[static_cast<std::size_t>(i)].dry_bulb_C = i % 24;
  }
  return series;
}

TEST(FillGaps, SixHoursAreALineSevenAreTheMonthsUsualDay) {
  const auto six =
      fill_gaps(may_without([](int i) { return i >= 245 && i < 251; }), calendar("UTC"));
  EXPECT_DOUBLE_EQ(six.series.hours[246].dry_bulb_C, 6.0);
  EXPECT_NEAR(six.coverage[0].interpolated[0], 6.0 / 744.0, 1e-12);
  // Bridging midnight shows which it was: a line rises nowhere to 23.
  const auto seven =
      fill_gaps(may_without([](int i) { return i >= 260 && i < 267; }), calendar("UTC"));
  EXPECT_DOUBLE_EQ(seven.series.hours[263].dry_bulb_C, 23.0);
  EXPECT_NEAR(seven.coverage[0].typical[0], 7.0 / 744.0, 1e-12);
  EXPECT_NEAR(seven.coverage[0].measured[0], 737.0 / 744.0, 1e-12);
}

TEST(FillGaps, VariablesAreFilledByThemselvesAndNotInvented) {
  const auto filled = fill_gaps(may_without([](int) { return false; }), calendar("UTC"));
  EXPECT_NEAR(filled.coverage[0].measured[0], 1.0, 1e-12);
  EXPECT_EQ(filled.coverage[0].measured[4], 0.0);
  EXPECT_EQ(filled.coverage[0].typical[4], 0.0);
  EXPECT_TRUE(std::isnan(filled.series.hours[0].ghi_W_m2));
}

TEST(FillGaps, DirectionTurnsTheShorterWay) {
  WeatherSeries series{kStart, std::vector<WeatherHour>(744)};
  for (auto& hour : series.hours) hour.wind_dir_deg = 350.0;
  series.hours[11].wind_dir_deg = kAbsent;
  series.hours[12].wind_dir_deg = 10.0;
  const auto filled = fill_gaps(series, calendar("UTC"));
  EXPECT_NEAR(std::remainder(filled.series.hours[11].wind_dir_deg, 360.0), 0.0, 1e-9);
}

// A record of 20 days of May: the other eleven are counted, and filled from the twenty.
TEST(FillGaps, MonthsAreWhole) {
  WeatherSeries series = may_without([](int) { return false; });
  series.hours.resize(480);
  const auto filled = fill_gaps(series, calendar("UTC"));
  EXPECT_EQ(filled.series.hours.size(), 744u);
  EXPECT_NEAR(filled.coverage[0].measured[0], 480.0 / 744.0, 1e-12);
  EXPECT_DOUBLE_EQ(filled.series.hours[743].dry_bulb_C, 23.0);
}

TEST(FillGaps, MonthsAndHoursAreLocal) {
  WeatherSeries series{kStart + hours{5}, std::vector<WeatherHour>(24)};
  for (auto& hour : series.hours) hour.dry_bulb_C = 1.0;
  const auto filled = fill_gaps(series, calendar("America/Chicago"));  // UTC−5 in May
  ASSERT_EQ(filled.coverage.size(), 1u);
  EXPECT_EQ(metering::to_string(filled.coverage[0].month), "2016-05");
  EXPECT_EQ(filled.series.begin, kStart + hours{5});
  EXPECT_EQ(filled.series.hours.size(), 744u);
  const auto march = fill_gaps({kStart - hours{24 * 40}, std::vector<WeatherHour>(10)},
                               calendar("America/Chicago"));
  EXPECT_EQ(march.series.hours.size(), 743u);
}

TEST(WeatherSeries, FindsTheHourOfAnInstant) {
  const WeatherSeries series = may_without([](int) { return false; });
  EXPECT_EQ(series.find(kStart + minutes{95})->dry_bulb_C, 1.0);
  EXPECT_EQ(series.find(kStart - seconds{1}), nullptr);
  EXPECT_EQ(series.find(series.end()), nullptr);
}

TEST(ContinuedWeather, TheLastWeekGoesOn) {
  WeatherSeries series;
  series.begin = std::chrono::sys_days{std::chrono::year{2026} / 1 / 1};
  for (int i = 0; i < 20 * 24; ++i) series.hours.push_back({.dry_bulb_C = 1.0 * i});
  const auto day = [&](int days) { return series.begin + std::chrono::hours{24 * days}; };
  const auto longer = continued(series, day(2), day(12), day(31));
  EXPECT_EQ(longer.begin, day(2));
  EXPECT_EQ(longer.end(), day(31));
  EXPECT_EQ(longer.find(day(11))->dry_bulb_C, 24.0 * 11);
  EXPECT_EQ(longer.find(day(12))->dry_bulb_C, 24.0 * 5) << "what came later is not known yet";
  EXPECT_EQ(longer.find(day(19))->dry_bulb_C, 24.0 * 5);
  EXPECT_EQ(longer.find(day(20))->dry_bulb_C, 24.0 * 6);
  EXPECT_EQ(continued(series, day(2), day(8), day(31)).end(), day(8)) << "less than a week";
  EXPECT_TRUE(continued(series, day(30), day(31), day(32)).hours.empty());
}

}  // namespace
}  // namespace recald::weather
