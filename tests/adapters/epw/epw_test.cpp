#include "adapters/epw/epw.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/support/data_folders.hpp"

namespace recald::epw {
namespace {

using metering::Instant;
using std::chrono::hours;
using std::chrono::sys_days;
using std::chrono::year;

const std::string kHeader =
    "LOCATION,Somewhere,ST,Land,TMY3,123456,40.0,-105.2,-7.0,1800.0\n"
    "DESIGN CONDITIONS,0\n"
    "TYPICAL/EXTREME PERIODS,0\n"
    "GROUND TEMPERATURES,0\n"
    "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\n"
    "COMMENTS 1,made for a test\n"
    "COMMENTS 2,\n"
    "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n";

/// A row whose dry bulb is `dry_bulb_C`; the rest is constant.
std::string row(int file_year, unsigned month, unsigned day, int hour, double dry_bulb_C,
                const char* humidity = "50") {
  char text[256];
  std::snprintf(text, sizeof text,
                "%d,%u,%u,%d,0,?9?9?9,%.1f,1.0,%s,82300,9999,9999,300,100,200,50,0,0,0,0,270,3.5,"
                "0,0,16,77777,9,999999999,5,0.0,0,88,0,0,0\n",
                file_year, month, day, hour, dry_bulb_C, humidity);
  return text;
}

/// A year of hours; the dry bulb is the day of the month, months come from `years[month]`.
std::string rows(bool leap_day, int (*year_of_month)(unsigned)) {
  std::string text;
  for (unsigned month = 1; month <= 12; ++month) {
    const auto days = static_cast<unsigned>(
        metering::days_in(year{leap_day ? 2012 : 2013} / std::chrono::month{month}));
    for (unsigned day = 1; day <= days; ++day) {
      for (int hour = 1; hour <= 24; ++hour)
        text += row(year_of_month(month), month, day, hour, day);
    }
  }
  return text;
}

int in_2013(unsigned) { return 2013; }
int in_2012(unsigned) { return 2012; }
int stitched(unsigned month) { return 1990 + static_cast<int>(month); }

TEST(Epw, HoursNameTheirEndInLocalStandardTime) {
  const auto weather = read_epw_text(kHeader + rows(false, in_2013), "a.epw");
  ASSERT_TRUE(weather.has_value()) << weather.error().message;
  // Row 1,1,1 is the hour from midnight at UTC−7.
  EXPECT_EQ(weather->series.begin, Instant{sys_days{year{2013} / 1 / 1}} + hours{7});
  EXPECT_EQ(weather->series.hours.size(), 8760u);
  EXPECT_EQ(weather->year, 2013);
  EXPECT_EQ(weather->location.city, "Somewhere");
  EXPECT_EQ(weather->location.longitude_deg, -105.2);
  // The last hour of 1 January belongs to the 1st; summer does not move the clock.
  const Instant second = Instant{sys_days{year{2013} / 1 / 2}} + hours{7};
  EXPECT_EQ(weather->series.find(second - hours{1})->dry_bulb_C, 1.0);
  EXPECT_EQ(weather->series.find(second + hours{1})->dry_bulb_C, 2.0);
  EXPECT_EQ(weather->series.find(Instant{sys_days{year{2013} / 7 / 4}} + hours{8})->dry_bulb_C,
            4.0);
  EXPECT_EQ(weather->series.hours[0].pressure_Pa, 82300.0);
  EXPECT_EQ(weather->series.hours[0].ghi_W_m2, 100.0);
  EXPECT_EQ(weather->series.hours[0].dhi_W_m2, 50.0);
}

// Temperature is the value at the end of a row's hour, irradiance the mean of the hour: the first
// hour of 2 January runs from 1 to 2 degrees.
TEST(Epw, TemperaturesAreInstantsAndBecomeMeans) {
  const std::string text = kHeader + rows(false, in_2013);
  const Instant second = Instant{sys_days{year{2013} / 1 / 2}} + hours{7};
  const auto usual = read_epw_text(text, "a.epw");
  ASSERT_TRUE(usual.has_value()) << usual.error().message;
  EXPECT_EQ(usual->series.find(second)->dry_bulb_C, 1.5);
  EXPECT_EQ(usual->series.find(second)->ghi_W_m2, 100.0);
  const auto declared = read_epw_text(text, "a.epw", {}, weather::RecordedValues::mean);
  EXPECT_EQ(declared->series.find(second)->dry_bulb_C, 2.0);
}

TEST(Epw, MissingCodesAreAbsent) {
  std::string text = rows(false, in_2013);
  text.replace(0, text.find('\n') + 1,
               "2013,1,1,1,0,?,99.9,99.9,999,999999,9999,9999,9999,9999,9999,9999,999999,999999,"
               "999999,9999,999,999,99,99,9999,99999,9,999999999,999,.999,999,99,999,999,99\n");
  const auto weather = read_epw_text(kHeader + text, "a.epw");
  ASSERT_TRUE(weather.has_value()) << weather.error().message;
  for (const auto& variable : weather::kWeatherVariables) {
    EXPECT_TRUE(std::isnan(weather->series.hours[0].*variable.member)) << variable.name;
    EXPECT_FALSE(std::isnan(weather->series.hours[1].*variable.member)) << variable.name;
  }
}

TEST(Epw, TypicalYearsAreLaidOnTheYearAsked) {
  const auto weather = read_epw_text(kHeader + rows(false, stitched), "a.epw", 2016);
  ASSERT_TRUE(weather.has_value()) << weather.error().message;
  EXPECT_TRUE(weather->typical);
  EXPECT_EQ(weather->series.hours.size(), 8784u);
  ASSERT_EQ(weather->notes.size(), 1u);
  EXPECT_EQ(weather->notes[0], "the file has no 29 February: the 28th stands for it");
  const Instant leap_day = Instant{sys_days{year{2016} / 2 / 29}} + hours{7};
  EXPECT_EQ(weather->series.find(leap_day)->dry_bulb_C, 28.0);
  EXPECT_EQ(weather->series.find(leap_day + hours{25})->dry_bulb_C, 1.0);
}

TEST(Epw, ALeapYearHas8784RowsAndMayLoseOneDay) {
  const auto leap = read_epw_text(kHeader + rows(true, in_2012), "a.epw");
  ASSERT_TRUE(leap.has_value()) << leap.error().message;
  EXPECT_EQ(leap->series.hours.size(), 8784u);
  EXPECT_TRUE(leap->leap_day);
  const auto plain = read_epw_text(kHeader + rows(true, in_2012), "a.epw", 2015);
  ASSERT_TRUE(plain.has_value());
  EXPECT_EQ(plain->series.hours.size(), 8760u);
  EXPECT_EQ(plain->series.find(Instant{sys_days{year{2015} / 3 / 1}} + hours{8})->dry_bulb_C, 1.0);
}

TEST(Epw, HumidityAboveAHundredIsClippedAndCounted) {
  std::string text = rows(false, in_2013);
  text.replace(0, text.find('\n') + 1, row(2013, 1, 1, 1, 1.0, "105"));
  const auto weather = read_epw_text(kHeader + text, "a.epw");
  ASSERT_TRUE(weather.has_value());
  EXPECT_EQ(weather->humidity_clipped, 1);
  EXPECT_EQ(weather->series.hours[0].rel_humidity_pct, 100.0);
}

std::string problem(const std::string& text, std::optional<int> wanted = {}) {
  const auto weather = read_epw_text(text, "a.epw", wanted);
  return weather ? std::string{"accepted"} : weather.error().message;
}

/// A year in which one field of some hours is another text. @param every  Of so many hours one.
std::string year_with(std::size_t place, const std::string& value, int every) {
  std::string text;
  int hour = 0;
  const std::string plain = rows(false, in_2013);
  for (std::size_t begin = 0; begin < plain.size();) {
    const std::size_t end = plain.find('\n', begin);
    std::string line = plain.substr(begin, end - begin);
    if (hour++ % every == 0) {
      std::size_t at = 0;
      for (std::size_t field = 0; field < place; ++field) at = line.find(',', at) + 1;
      line.replace(at, line.find(',', at) - at, value);
    }
    text += line + "\n";
    begin = end + 1;
  }
  return kHeader + text;
}

// Another unit, another column, a sensor that is broken: of each variable, below and above.
TEST(Epw, WhatCannotBeMeasuredOnTheGroundIsNoValue) {
  const std::vector<
      std::tuple<std::size_t, const char*, double weather::WeatherHour::*, const char*>>
      cases{{6, "99.8", &weather::WeatherHour::dry_bulb_C, "dry_bulb_C"},
            {6, "-273.16", &weather::WeatherHour::dry_bulb_C, "dry_bulb_C"},
            {8, "-50", &weather::WeatherHour::rel_humidity_pct, "rel_humidity_pct"},
            {8, "180", &weather::WeatherHour::rel_humidity_pct, "rel_humidity_pct"},
            {9, "0", &weather::WeatherHour::pressure_Pa, "pressure_Pa"},
            {9, "96.5", &weather::WeatherHour::pressure_Pa, "pressure_Pa"},
            {13, "-999", &weather::WeatherHour::ghi_W_m2, "ghi_W_m2"},
            {13, "1e300", &weather::WeatherHour::ghi_W_m2, "ghi_W_m2"},
            {14, "5000", &weather::WeatherHour::dni_W_m2, "dni_W_m2"},
            {15, "-1e9", &weather::WeatherHour::dhi_W_m2, "dhi_W_m2"},
            {20, "400", &weather::WeatherHour::wind_dir_deg, "wind_dir_deg"},
            {21, "-1e9", &weather::WeatherHour::wind_speed_m_s, "wind_speed_m_s"}};
  for (const auto& [place, value, member, name] : cases) {
    const std::string all = problem(year_with(place, value, 1));
    EXPECT_NE(all.find(std::string{name} + " lies between"), std::string::npos) << all;
    EXPECT_NE(all.find("8760 of 8760 hours"), std::string::npos) << all;
    EXPECT_NE(problem(year_with(place, value, 19)).find("462 of 8760"), std::string::npos) << name;
    const auto few = read_epw_text(year_with(place, value, 21), "a.epw");
    ASSERT_TRUE(few.has_value()) << few.error().message;
    EXPECT_TRUE(std::isnan(few->series.hours[0].*member)) << name;
    ASSERT_EQ(few->notes.size(), 1U);
    EXPECT_NE(
        few->notes[0].find("418 of 8760 hours have other values, the first '" + std::string{value} +
                           "' on line 9; they are taken as not measured"),
        std::string::npos)
        << few->notes[0];
  }
}

TEST(EpwBadInput, EachHasItsSentence) {
  const std::string good = rows(false, in_2013);
  EXPECT_EQ(read_epw("/no/such.epw").error().message, "EPW file '/no/such.epw' does not exist");
  EXPECT_NE(problem("").find("line 1: this header line of an EPW file must begin with 'LOCATION'"),
            std::string::npos);
  EXPECT_NE(problem("LOCATION,x\n").find("latitude, longitude"), std::string::npos);
  std::string half_hourly = kHeader;
  half_hourly.replace(half_hourly.find("DATA PERIODS,1,1"), 16, "DATA PERIODS,1,2");
  EXPECT_NE(problem(half_hourly + good).find("one record an hour"), std::string::npos);
  EXPECT_NE(problem(kHeader + row(2013, 1, 1, 2, 5.0)).find("expected month 1, day 1, hour 1"),
            std::string::npos);
  EXPECT_NE(problem(kHeader + "2013,1,1,1,0\n").find("at least 22 fields, this one 5"),
            std::string::npos);
  std::string letters = row(2013, 1, 1, 1, 5.0);
  letters.replace(letters.find(",5.0,"), 5, ",5.o,");
  EXPECT_NE(problem(kHeader + letters).find("line 9: field 7 '5.o' is not a number"),
            std::string::npos);
  EXPECT_NE(problem(kHeader + good + row(2013, 1, 1, 1, 5.0)).find("expected the end of the file"),
            std::string::npos);
  EXPECT_NE(problem(kHeader + good, 2040).find("1972 to 2036"), std::string::npos);
}

TEST(EpwBadInput, ATruncatedFileNamesTheFirstMissingHour) {
  const std::string good = kHeader + rows(false, in_2013);
  const std::size_t may = good.find("2013,5,3,6,");
  EXPECT_EQ(problem(good.substr(0, may)),
            "'a.epw' ends early: the first missing hour is month 5, day 3, hour 6; 2933 of 8760 "
            "hours are there");
  EXPECT_EQ(problem(good.substr(0, may + 40)),  // the cut row is not there
            problem(good.substr(0, may)));
}

// Cut anywhere, the file is refused: never a crash, never a year with hours made up.
TEST(EpwBadInput, CutAtEveryByteOfHeaderAndFirstRows) {
  const std::string text = kHeader + row(2013, 1, 1, 1, 5.0) + row(2013, 1, 1, 2, 6.0);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    EXPECT_NE(problem(text.substr(0, cut)), "accepted") << cut;
  }
}

std::filesystem::path weather_file(const char* name) {
  return testing::others_data("weather") / name;
}

// Annual mean dry bulbs were summed from the files' seventh column by awk.
TEST(EpwRealFiles, MeasuredAndTypicalYears) {
  const auto golden = weather_file("USA_CO_Golden-SRRL_2012_AMY.epw");
  const auto atlanta = weather_file("USA_GA_Atlanta-Hartsfield-Jackson.Intl.AP.722190_TMY3.epw");
  if (!std::filesystem::exists(golden)) {
    GTEST_SKIP() << golden << " is not here; set RECALD_DATA to the data folder";
  }
  const auto measured = read_epw(golden, {}, weather::RecordedValues::mean);
  ASSERT_TRUE(measured.has_value()) << measured.error().message;
  EXPECT_EQ(measured->series.hours.size(), 8784u);
  EXPECT_EQ(measured->year, 2012);
  EXPECT_FALSE(measured->typical);
  EXPECT_EQ(measured->humidity_clipped, 82);
  EXPECT_NEAR(measured->series.hours[0].pressure_Pa, 82300.0, 1e-9);
  const auto typical = read_epw(atlanta, 2015, weather::RecordedValues::mean);
  ASSERT_TRUE(typical.has_value()) << typical.error().message;
  EXPECT_TRUE(typical->typical);
  EXPECT_EQ(typical->series.hours.size(), 8760u);
  const auto mean_C = [](const EpwWeather& weather) {
    double sum_C = 0.0;
    for (const auto& hour : weather.series.hours) sum_C += hour.dry_bulb_C;
    return sum_C / static_cast<double>(weather.series.hours.size());
  };
  EXPECT_NEAR(mean_C(*measured), 12.594865665, 1e-8);
  EXPECT_NEAR(mean_C(*typical), 16.652899543, 1e-8);
}

}  // namespace
}  // namespace recald::epw
