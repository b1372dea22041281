#include "adapters/epw/epw_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "adapters/epw/epw.hpp"

namespace recald::epw::epw_writer_test {
namespace {

using metering::LocalCalendar;
using ::testing::HasSubstr;
using weather::WeatherHour;
using weather::WeatherSeries;

/// Hourly means of a smooth year and a day on either side.
WeatherSeries smooth_year(int year, std::chrono::hours offset) {
  using namespace std::chrono;
  WeatherSeries series{.begin = sys_days{std::chrono::year{year} / 1 / 1} - offset - days{1},
                       .hours = {}};
  for (int hour = 0; hour < 24 * 369; ++hour) {
    const double day = 2.0 * std::numbers::pi * hour / 24.0;
    WeatherHour& one = series.hours.emplace_back();
    one.dry_bulb_C = 10.0 + 5.0 * std::sin(day);
    one.rel_humidity_pct = 60.0 + 10.0 * std::cos(day);
    one.wind_speed_m_s = 3.0;
    one.ghi_W_m2 = std::max(400.0 * std::sin(day), 0.0);
  }
  return series;
}

constexpr weather::Location kPlace{.latitude_deg = 52.5, .longitude_deg = 13.4, .altitude_m = 40.0};

TEST(EpwWriter, ReadBackItIsTheSameWeather) {
  const auto calendar = LocalCalendar::open("Europe/Berlin").value();
  const WeatherSeries written = smooth_year(2024, std::chrono::hours{1});
  const auto text =
      epw_text(written, 2024, kPlace, calendar, {std::chrono::year{2024} / 12 / 25}, "Town hall");
  ASSERT_TRUE(text.has_value()) << text.error().message;
  EXPECT_THAT(*text, HasSubstr("LOCATION,Town hall,-,-,recald,0,52.5000,13.4000,1.00,40.0"));
  EXPECT_THAT(*text, HasSubstr("SAVINGS,Yes,3/31,10/26,1,Holiday 1,12/25"));
  EXPECT_THAT(*text, HasSubstr("DATA PERIODS,1,1,Data,Monday,1/1/2024,12/31/2024"));
  const auto read = read_epw_text(*text, "w.epw");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_FALSE(read->typical);
  EXPECT_TRUE(read->leap_day);
  ASSERT_EQ(read->series.hours.size(), 8784u);
  EXPECT_EQ(metering::to_string(read->series.begin), "2023-12-31T23:00:00Z");
  for (std::size_t i = 24; i < 8700; ++i) {
    const WeatherHour& back = read->series.hours[i];
    const WeatherHour& before = *written.find(read->series.begin + std::chrono::hours{i});
    // Means become instants and means again, which rounds off a swing a little.
    ASSERT_NEAR(back.dry_bulb_C, before.dry_bulb_C, 0.1) << i;
    ASSERT_NEAR(back.rel_humidity_pct, before.rel_humidity_pct, 0.3) << i;
    ASSERT_NEAR(back.ghi_W_m2, before.ghi_W_m2, 0.06) << i;
    ASSERT_NEAR(back.wind_speed_m_s, 3.0, 0.01) << i;
  }
}

TEST(EpwWriter, NamesTheFirstHourThatLacksSomething) {
  const auto calendar = LocalCalendar::open("Europe/Berlin").value();
  WeatherSeries weather = smooth_year(2023, std::chrono::hours{1});
  weather.hours[24 + 5].wind_speed_m_s = NAN;
  EXPECT_THAT(epw_text(weather, 2023, kPlace, calendar, {}, "x").error().message,
              HasSubstr("the weather lacks wind at 2023-01-01T04:00:00Z"));
  weather.hours.resize(100);
  EXPECT_FALSE(epw_text(weather, 2023, kPlace, calendar, {}, "x").has_value());
}

TEST(EpwWriter, SummerTimeGoesOverNewYearInTheSouth) {
  const auto calendar = LocalCalendar::open("Australia/Sydney").value();
  const auto text = epw_text(smooth_year(2023, std::chrono::hours{10}), 2023,
                             {.latitude_deg = -33.9, .longitude_deg = 151.2}, calendar, {}, "x");
  ASSERT_TRUE(text.has_value()) << text.error().message;
  EXPECT_THAT(*text, HasSubstr("SAVINGS,No,10/1,4/1,0"));
}

}  // namespace
}  // namespace recald::epw::epw_writer_test
