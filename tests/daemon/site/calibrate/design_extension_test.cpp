#include "daemon/site/calibrate/design_extension.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/absent.hpp"
#include "core/random/rng.hpp"
#include "core/weather/daily_inputs.hpp"
#include "core/weather/monthly_inputs.hpp"

namespace recald::daemon::design_extension_test {
namespace {

using Eigen::Index;
using metering::Month;
using std::chrono::hours;
using std::chrono::sys_days;
using std::chrono::year;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<Month> months_of(int of_year) {
  std::vector<Month> months;
  for (unsigned month = 1; month <= 12; ++month) {
    months.push_back(year{of_year} / std::chrono::month{month});
  }
  return months;
}

/// Three years from 2020 in UTC, with anomalies of their own; the last `offset_K` warmer.
weather::WeatherSeries three_years(double offset_K) {
  Rng rng{17};
  weather::WeatherSeries series{sys_days{year{2020} / 1 / 1}, {}};
  double anomaly_K = 0.0;
  for (int day = 0; day < 1096; ++day) {
    anomaly_K = 0.8 * anomaly_K + 1.8 * rng.normal();
    const double season = 2.0 * std::numbers::pi * (day % 365) / 365.0;
    const double cloud = rng.uniform(0.3, 1.0);
    for (int hour = 0; hour < 24; ++hour) {
      const double height = std::sin(2.0 * std::numbers::pi * (hour - 6) / 24.0);
      series.hours.push_back(
          {.dry_bulb_C = 11.0 - 11.0 * std::cos(season) + anomaly_K + 4.0 * height +
                         (day >= 731 ? offset_K : 0.0),
           .rel_humidity_pct = 65.0,
           .wind_speed_m_s = 2.0 + 2.0 * cloud,
           .ghi_W_m2 = std::max(0.0, (500.0 - 300.0 * std::cos(season)) * height * cloud)});
    }
  }
  return series;
}

struct Case {
  metering::LocalCalendar calendar = *metering::LocalCalendar::open("UTC");
  weather::WeatherSeries weather;
  doe::DesignFolder design;
  doe::DesignDays days;
};

/// Cooling of three runs on a day: kWh, and kW at its peak. More in warm and sunny hours, little at
/// weekends, none below 12 °C.
Eigen::MatrixXd made_days(const Case& made, const std::vector<metering::Day>& days) {
  Eigen::MatrixXd values(3, 2 * static_cast<Index>(days.size()));
  for (Index i = 0; i < static_cast<Index>(days.size()); ++i) {
    const metering::Day day = days[static_cast<std::size_t>(i)];
    const double share = model::day_type(day, {}) == model::DayType::workday ? 1.0 : 0.3;
    for (Index run = 0; run < 3; ++run) {
      double energy_kWh = 0.0;
      double highest_kW = 0.0;
      for (int hour = 8; hour < 18; ++hour) {
        const auto* now = made.weather.find(sys_days{day} + hours{hour});
        const double power_kW =
            share * (20.0 + (2.0 + static_cast<double>(run)) *
                                std::max(now->dry_bulb_C - 12.0 + 0.01 * now->ghi_W_m2, 0.0));
        energy_kWh += power_kW;
        highest_kW = std::max(highest_kW, power_kW);
      }
      values(run, i) = energy_kWh;
      values(run, static_cast<Index>(days.size()) + i) = highest_kW;
    }
  }
  return values;
}

/// (runs x outputs * months) of days of these months.
Eigen::MatrixXd made_months(const Case& made, const std::vector<Month>& months) {
  const auto count = static_cast<Index>(months.size());
  Eigen::MatrixXd figures(3, 2 * count);
  for (Index m = 0; m < count; ++m) {
    const auto days = weather::days_of({months[static_cast<std::size_t>(m)]});
    const Eigen::MatrixXd values = made_days(made, days);
    const auto n = static_cast<Index>(days.size());
    figures.col(m) = values.leftCols(n).rowwise().mean();
    figures.col(count + m) = values.rightCols(n).rowwise().maxCoeff();
  }
  return figures;
}

/// A design over 2020 and 2021; the weather goes on to the end of 2022.
Case made_case(double offset_K = 0.0) {
  Case made{.weather = three_years(offset_K), .design = {}, .days = {}};
  std::vector<Month> months = months_of(2020);
  for (const Month month : months_of(2021)) months.push_back(month);
  made.design.folder = "runs";
  made.design.runs = {1, 2, 3};
  made.design.output_names = {"chw_daily_kWh", "chw_peak_kW"};
  for (const Month month : months) {
    made.design.months.push_back(*doe::DesignMonth::parse(metering::to_string(month)));
  }
  made.design.outputs = made_months(made, months);
  const auto inputs = weather::monthly_inputs(made.weather, made.calendar, months);
  made.design.inputs = {made.design.months, inputs.names, inputs.values};
  made.days.days = weather::days_of(months);
  made.days.values = made_days(made, made.days.days);
  return made;
}

Result<DesignExtension> extend(const Case& made, const std::vector<Month>& wanted) {
  return extend_design(made.design, made.days, made.weather, made.calendar, {}, wanted);
}

TEST(DesignExtension, PredictsAYearThatWasNotSimulated) {
  const Case made = made_case();
  const auto extended = extend(made, months_of(2022));
  ASSERT_TRUE(extended.has_value()) << extended.error().message;
  ASSERT_EQ(extended->added.size(), 12u);
  const doe::DesignFolder& design = extended->design;
  ASSERT_EQ(design.months.size(), 36u);
  ASSERT_EQ(design.outputs.cols(), 72);
  // What was simulated stays to the last bit.
  EXPECT_EQ(design.outputs.leftCols(24), made.design.outputs.leftCols(24));
  EXPECT_EQ(design.outputs.middleCols(36, 24), made.design.outputs.rightCols(24));
  const Eigen::MatrixXd truth = made_months(made, months_of(2022));
  for (Index k = 0; k < 2; ++k) {
    const auto expected = truth.middleCols(12 * k, 12);
    const Eigen::MatrixXd error = design.outputs.middleCols(36 * k + 24, 12) - expected;
    const double cv = std::sqrt(error.array().square().mean()) / expected.mean();
    EXPECT_LT(cv, k == 0 ? 0.02 : 0.05) << "output " << k;
    EXPECT_LT(extended->error_sd[k], (k == 0 ? 0.03 : 0.06) * expected.mean());
    EXPECT_GT(extended->error_sd[k], 0.0);
  }
  EXPECT_EQ(extended->month_error_sd.rows(), 2);
  EXPECT_EQ(extended->month_error_sd.cols(), 12);
  EXPECT_EQ(design.inputs.months, design.months);
  const auto inputs = weather::monthly_inputs(made.weather, made.calendar, months_of(2022));
  EXPECT_EQ(design.inputs.values(30, 0), inputs.values(6, 0));
  EXPECT_THAT(extended->notes, IsEmpty());
}

TEST(DesignExtension, WeatherThatNoRunHasSeenIsSaid) {
  const auto extended = extend(made_case(6.0), {year{2022} / 7, year{2022} / 4});
  ASSERT_TRUE(extended.has_value()) << extended.error().message;
  ASSERT_FALSE(extended->notes.empty());
  EXPECT_THAT(extended->notes.front(),
              HasSubstr("has not seen such weather: temperature, °C, was"));
  EXPECT_THAT(extended->notes.front(), HasSubstr("in 2022-07; its months had"));
}

TEST(DesignExtension, MonthsBetweenAreSortedInAndKnownOnesPassedOver) {
  Case made = made_case();
  // Without April 2020, which is then wanted together with a month that is there.
  std::vector<Index> kept;
  for (Index i = 0; i < 48; ++i) {
    if (i % 24 != 3) kept.push_back(i);
  }
  const Eigen::MatrixXd truth = made.design.outputs;
  made.design.outputs = truth(Eigen::all, kept).eval();
  made.design.months.erase(made.design.months.begin() + 3);
  const auto extended = extend(made, {year{2021} / 5, year{2020} / 4, year{2020} / 4});
  ASSERT_TRUE(extended.has_value()) << extended.error().message;
  EXPECT_THAT(extended->added, ElementsAre(year{2020} / 4));
  ASSERT_EQ(extended->design.outputs.cols(), 48);
  EXPECT_LT((extended->design.outputs - truth).cwiseAbs().maxCoeff(), 0.1 * truth.mean());
  EXPECT_EQ(extended->design.outputs.col(4), truth.col(4));
}

TEST(DesignExtension, AMonthWithoutWeatherIsLeftOutAndSaid) {
  Case made = made_case();
  for (std::size_t i = 24 * (731 + 40); i < 24 * (731 + 50); ++i) {
    made.weather.hours[i].ghi_W_m2 = kAbsent;  // ten days of February
  }
  const auto extended = extend(made, {year{2022} / 2, year{2022} / 3, year{2023} / 1});
  ASSERT_TRUE(extended.has_value()) << extended.error().message;
  EXPECT_THAT(extended->added, ElementsAre(year{2022} / 3));
  EXPECT_THAT(extended->notes,
              ElementsAre("2022-02 cannot be predicted from the design: its weather is known on 18 "
                          "of 28 days.",
                          "2023-01 cannot be predicted from the design: its weather is known on 0 "
                          "of 31 days."));
}

TEST(DesignExtension, DesignsThatCannotBeContinuedAreRefused) {
  Case numbered = made_case();
  numbered.design.months.assign(1, *doe::DesignMonth::parse("3"));
  EXPECT_EQ(extend(numbered, months_of(2022)).error().code, ErrorCode::unsupported);
  Case others = made_case();
  others.design.inputs.names.front() = "snow";
  EXPECT_THAT(extend(others, months_of(2022)).error().message, HasSubstr("model input 'snow'"));
  Case elsewhere = made_case();
  elsewhere.weather.hours.erase(elsewhere.weather.hours.begin(),
                                elsewhere.weather.hours.begin() + 24 * 700);
  elsewhere.weather.begin += hours{24 * 700};
  EXPECT_EQ(extend(elsewhere, {year{2022} / 6}).error().code, ErrorCode::not_enough_data);
}

}  // namespace
}  // namespace recald::daemon::design_extension_test
