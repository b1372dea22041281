#include "core/weather/merged_weather.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/absent.hpp"

namespace recald::weather::merged_weather_test {
namespace {

using std::chrono::hours;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};
const metering::TimeSpan kDay{kStart, kStart + hours{24}};

/// Hours [from, to) of one day, all variables of a kind with one value.
WeatherSeries series(int from, int to, double value) {
  WeatherSeries made;
  made.begin = kStart + hours{from};
  made.hours.resize(static_cast<std::size_t>(to - from));
  for (WeatherHour& hour : made.hours) hour.dry_bulb_C = value;
  return made;
}

double dry_bulb_C(const MergedWeather& merged, std::size_t hour) {
  return merged.series.hours[hour].dry_bulb_C;
}

TEST(MergedWeather, TheFirstSourceThatHasAnHourGivesIt) {
  WeatherSeries sensor = series(6, 20, 1.0);
  sensor.hours[4].dry_bulb_C = kAbsent;  // at ten
  const WeatherSeries file = series(0, 12, 2.0);
  const std::array<WeatherSource, 2> sources{{{&sensor, true}, {&file}}};
  const MergedWeather merged = merge_weather(kDay, sources);
  ASSERT_EQ(merged.series.hours.size(), 24U);
  EXPECT_EQ(merged.series.begin, kStart);
  EXPECT_EQ(dry_bulb_C(merged, 5), 2.0);
  EXPECT_EQ(dry_bulb_C(merged, 6), 1.0);
  EXPECT_EQ(dry_bulb_C(merged, 10), 2.0);
  EXPECT_EQ(dry_bulb_C(merged, 19), 1.0);
  EXPECT_TRUE(std::isnan(dry_bulb_C(merged, 20)));
  EXPECT_EQ(merged.source[5][0], 2);
  EXPECT_EQ(merged.source[6][0], 1);
  EXPECT_EQ(merged.source[20][0], 0);
}

// Weather of another year is no measurement of a gap, but better than nothing for the time before.
TEST(MergedWeather, ATypicalYearStandsBeforeTheSensorAlone) {
  WeatherSeries sensor = series(6, 20, 1.0);
  sensor.hours[4].dry_bulb_C = kAbsent;
  WeatherSeries file = series(0, 24, 2.0);
  for (WeatherHour& hour : file.hours) hour.wind_speed_m_s = 3.0;
  std::array<WeatherSource, 2> sources{{{&sensor, true}, {&file, false, true}}};
  sources[0].begun[0] = kStart + hours{6};
  const MergedWeather merged = merge_weather(kDay, sources);
  EXPECT_EQ(dry_bulb_C(merged, 5), 2.0);
  EXPECT_TRUE(std::isnan(dry_bulb_C(merged, 10)));
  EXPECT_TRUE(std::isnan(dry_bulb_C(merged, 22)));
  // What no sensor measures at all it has all along.
  EXPECT_EQ(merged.series.hours[10].wind_speed_m_s, 3.0);
  EXPECT_EQ(merged.series.hours[22].wind_speed_m_s, 3.0);
}

// A sensor that was silent all through the span had begun all the same.
TEST(MergedWeather, ATypicalYearFillsNoGapThatIsAsLongAsTheSpan) {
  const WeatherSeries sensor = series(0, 8, 1.0);
  const WeatherSeries file = series(0, 24, 2.0);
  std::array<WeatherSource, 2> sources{{{&sensor, true}, {&file, false, true}}};
  sources[0].begun[0] = kStart;
  const MergedWeather late = merge_weather({kStart + hours{10}, kStart + hours{20}}, sources);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_TRUE(std::isnan(dry_bulb_C(late, i))) << i;
}

TEST(MergedWeather, BeamOfAFileDoesNotStandBesideASensorsSun) {
  WeatherSeries sensor = series(0, 24, 1.0);
  WeatherSeries file = series(0, 24, 2.0);
  for (WeatherHour& hour : file.hours) {
    hour.ghi_W_m2 = 500.0;
    hour.dni_W_m2 = 700.0;
    hour.dhi_W_m2 = 100.0;
  }
  const auto beam_at_noon = [&] {
    const std::array<WeatherSource, 2> sources{{{&sensor, true}, {&file}}};
    return merge_weather(kDay, sources).series.hours[12].dni_W_m2;
  };
  EXPECT_EQ(beam_at_noon(), 700.0);
  sensor.hours[8].ghi_W_m2 = 450.0;
  EXPECT_TRUE(std::isnan(beam_at_noon()));
}

TEST(MergedWeather, HolesAreLongStretchesWithinASpan) {
  WeatherSeries some = series(3, 24, 1.0);
  for (std::size_t i = 5; i < 12; ++i) some.hours[i].dry_bulb_C = kAbsent;   // eight to fifteen
  for (std::size_t i = 14; i < 17; ++i) some.hours[i].dry_bulb_C = kAbsent;  // three hours
  const auto holes = holes_in(some, 0, kDay, hours{6});
  ASSERT_EQ(holes.size(), 1U);
  EXPECT_EQ(holes[0].span.begin, kStart + hours{8});
  EXPECT_EQ(holes[0].span.end, kStart + hours{15});
  // Before the series begins and after it ends nothing is known either.
  const auto around = holes_in(some, 0, {kStart - hours{10}, kStart + hours{40}}, hours{6});
  ASSERT_EQ(around.size(), 3U);
  EXPECT_EQ(around[0].span.begin, kStart - hours{10});
  EXPECT_EQ(around[0].span.end, kStart + hours{3});
  EXPECT_EQ(around[2].span.end, kStart + hours{40});
}

}  // namespace
}  // namespace recald::weather::merged_weather_test
