#include "core/weather/monthly_inputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace recald::weather {
namespace {

using std::chrono::hours;
using std::chrono::sys_days;
using std::chrono::year;
using ::testing::ElementsAre;

const std::vector<metering::Month> kMonths = {year{2021} / std::chrono::January,
                                              year{2021} / std::chrono::February};

metering::LocalCalendar calendar_in(const char* zone) {
  return *metering::LocalCalendar::open(zone);
}

/// January and February 2021 and two days on either side, each hour as `make(is_january, i)` says.
template <class Make>
WeatherSeries two_months(Make make) {
  WeatherSeries series{sys_days{year{2020} / 12 / 30}, {}};
  const Instant february = sys_days{year{2021} / 2 / 1};
  for (int i = 0; i < 24 * 63; ++i) {
    series.hours.push_back(make(series.begin + hours{i} < february, i));
  }
  return series;
}

double value(const MonthlyInputs& inputs, const std::string& name, Eigen::Index month) {
  for (std::size_t k = 0; k < inputs.names.size(); ++k) {
    if (inputs.names[k] == name) return inputs.values(month, static_cast<Eigen::Index>(k));
  }
  ADD_FAILURE() << "no column " << name;
  return std::nan("");
}

TEST(MonthlyInputs, AreMeansOfTheMonth) {
  const WeatherSeries weather = two_months([](bool january, int i) {
    return WeatherHour{.dry_bulb_C = (january ? 5.0 : 9.0) + (i % 2 == 0 ? 1.0 : -1.0),
                       .rel_humidity_pct = january ? 60.0 : 80.0,
                       .wind_speed_m_s = january ? 3.0 : 4.0,
                       .wind_dir_deg = january ? 0.0 : 90.0};
  });
  const MonthlyInputs inputs = monthly_inputs(weather, calendar_in("UTC"), kMonths);
  EXPECT_THAT(inputs.names, ElementsAre("dry_bulb_C", "rel_humidity_pct", "wind_speed_m_s",
                                        "wind_dir_sin", "wind_dir_cos"));
  EXPECT_NEAR(value(inputs, "dry_bulb_C", 0), 5.0, 1e-12);
  EXPECT_NEAR(value(inputs, "dry_bulb_C", 1), 9.0, 1e-12);
  EXPECT_NEAR(value(inputs, "rel_humidity_pct", 1), 80.0, 1e-12);
  EXPECT_NEAR(value(inputs, "wind_speed_m_s", 0), 3.0, 1e-12);
}

// 350° and 10° average to north; in plain degrees they would average to south.
TEST(MonthlyInputs, WindDirectionIsAveragedAroundTheCircle) {
  const WeatherSeries weather = two_months([](bool january, int i) {
    const double side_deg = i % 2 == 0 ? -10.0 : 10.0;
    return WeatherHour{
        .wind_speed_m_s = 2.0,
        .wind_dir_deg = january ? std::fmod(360.0 + side_deg, 360.0) : 90.0 + side_deg};
  });
  const MonthlyInputs inputs = monthly_inputs(weather, calendar_in("UTC"), kMonths);
  EXPECT_NEAR(value(inputs, "wind_dir_sin", 0), 0.0, 1e-12);
  EXPECT_NEAR(value(inputs, "wind_dir_cos", 0), 1.0, 1e-12);
  EXPECT_NEAR(value(inputs, "wind_dir_sin", 1), 1.0, 1e-12);
  EXPECT_NEAR(value(inputs, "wind_dir_cos", 1), 0.0, 1e-12);
}

// 3 m/s from the north and 4 m/s from the east: the mean vector lies at (4, 3) / 5.
TEST(MonthlyInputs, StrongWindsWeighMoreInTheDirection) {
  const WeatherSeries weather = two_months([](bool january, int i) {
    const bool north = i % 2 == 0;
    return WeatherHour{.wind_speed_m_s = north ? 3.0 : 4.0,
                       .wind_dir_deg = north || !january ? 0.0 : 90.0};
  });
  const MonthlyInputs inputs = monthly_inputs(weather, calendar_in("UTC"), kMonths);
  EXPECT_NEAR(value(inputs, "wind_dir_sin", 0), 0.8, 1e-12);
  EXPECT_NEAR(value(inputs, "wind_dir_cos", 0), 0.6, 1e-12);
}

TEST(MonthlyInputs, LeavesOutWhatDoesNotVaryAndWhatAMonthLacks) {
  const WeatherSeries weather = two_months([](bool january, int) {
    return WeatherHour{.dry_bulb_C = january ? 5.0 : 9.0,
                       .rel_humidity_pct = january ? 60.0 : kAbsent,
                       .wind_speed_m_s = 3.0};
  });
  EXPECT_THAT(monthly_inputs(weather, calendar_in("UTC"), kMonths).names,
              ElementsAre("dry_bulb_C"));
}

TEST(MonthlyInputs, SingleBlankHoursDoNotCount) {
  const WeatherSeries weather = two_months([](bool january, int i) {
    return WeatherHour{.dry_bulb_C = i % 3 == 0 ? kAbsent : (january ? 5.0 : 9.0)};
  });
  const MonthlyInputs inputs = monthly_inputs(weather, calendar_in("UTC"), kMonths);
  EXPECT_NEAR(value(inputs, "dry_bulb_C", 0), 5.0, 1e-12);
  EXPECT_NEAR(value(inputs, "dry_bulb_C", 1), 9.0, 1e-12);
}

// Local January in Chicago ends six hours into UTC's February: 6 of its 744 hours read 9 °C.
TEST(MonthlyInputs, MonthsAreLocal) {
  const WeatherSeries weather =
      two_months([](bool january, int) { return WeatherHour{.dry_bulb_C = january ? 5.0 : 9.0}; });
  const MonthlyInputs inputs = monthly_inputs(weather, calendar_in("America/Chicago"), kMonths);
  EXPECT_NEAR(value(inputs, "dry_bulb_C", 0), 5.0 + 4.0 * 6.0 / 744.0, 1e-12);
}

TEST(MonthlyInputs, MonthOutsideTheWeatherLeavesNoColumn) {
  const WeatherSeries weather =
      two_months([](bool january, int) { return WeatherHour{.dry_bulb_C = january ? 5.0 : 9.0}; });
  const metering::Month june = year{2021} / std::chrono::June;
  for (const auto& months :
       {std::vector{kMonths[0], kMonths[1], june}, std::vector{kMonths[0], june, kMonths[1]},
        std::vector{june, kMonths[0], kMonths[1]}}) {
    const MonthlyInputs inputs = monthly_inputs(weather, calendar_in("UTC"), months);
    EXPECT_TRUE(inputs.names.empty());
    EXPECT_EQ(inputs.values.cols(), 0);
    EXPECT_EQ(inputs.values.rows(), 3);
  }
}

}  // namespace
}  // namespace recald::weather
