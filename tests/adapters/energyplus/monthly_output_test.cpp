#include "adapters/energyplus/run/monthly_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace recald::energyplus::monthly_output_test {
namespace {

using metering::LocalCalendar;
using ::testing::ElementsAre;

TEST(SignedMeter, MinusSubtracts) {
  EXPECT_EQ(parse_signed_meter("-Cooling:Electricity").name, "Cooling:Electricity");
  EXPECT_EQ(parse_signed_meter("-Cooling:Electricity").sign, -1.0);
  EXPECT_EQ(parse_signed_meter("Electricity:Facility").sign, 1.0);
}

/// One kWh in each quarter of an hour, three in the second of each day.
MeterOutput steady(const std::string& name, metering::Instant begin, int days, double kWh) {
  MeterOutput meter{name, {}, {}};
  for (int i = 0; i < 96 * days; ++i) {
    meter.starts.push_back(begin + std::chrono::minutes{15} * i);
    meter.energy_kWh.push_back(i % 96 == 1 ? 3.0 * kWh : kWh);
  }
  return meter;
}

TEST(MonthlyFigures, AreOfLocalMonthsAndSumMeters) {
  using namespace std::chrono;
  const auto calendar = LocalCalendar::open("Europe/Berlin").value();
  // From 31 May on, in winter time; June begins an hour earlier by the clock.
  const auto begin = sys_days{year{2021} / 5 / 31} - hours{1};
  const std::vector<ModelOutput> outputs{{"electricity", {{"a", 1.0}, {"b", -1.0}}, false},
                                         {"electricity", {{"a", 1.0}}, true}};
  EXPECT_THAT(meters_of(outputs), ElementsAre("a", "b"));
  const std::vector<MeterOutput> meters{steady("a", begin, 33, 2.0), steady("b", begin, 33, 0.5)};
  const std::vector<metering::Month> months{year{2021} / 6, year{2021} / 7};
  const auto figures = monthly_figures(meters, outputs, months, calendar, minutes{15});
  ASSERT_EQ(figures.size(), 4u);
  EXPECT_DOUBLE_EQ(figures[0], 1.5 * 98.0);
  EXPECT_TRUE(std::isnan(figures[1]));  // July is not there whole
  EXPECT_DOUBLE_EQ(figures[2], 24.0);
  const auto hourly = monthly_figures(meters, outputs, months, calendar, minutes{60});
  EXPECT_DOUBLE_EQ(hourly[2], 12.0);
}

// In Sydney New Year's Day begins at 23:00 of standard time, before the run of the year.
TEST(MonthlyFigures, SummerTimeAtNewYearCostsAnHour) {
  using namespace std::chrono;
  const auto calendar = LocalCalendar::open("Australia/Sydney").value();
  const auto begin = sys_days{year{2021} / 1 / 1} - hours{10};
  const std::vector<ModelOutput> outputs{{"a", {{"a", 1.0}}, false}};
  const std::vector<MeterOutput> meters{steady("a", begin, 365, 2.0)};
  const std::vector<metering::Month> months{year{2021} / 1, year{2021} / 12};
  const auto figures = monthly_figures(meters, outputs, months, calendar, minutes{15});
  EXPECT_NEAR(figures[0], 2.0 * 98.0, 1.0);
  EXPECT_NEAR(figures[1], 2.0 * 98.0, 1.0);
}

TEST(MonthlyFigures, NoiseOfIntervalsLiftsAPeak) {
  using namespace std::chrono;
  const auto calendar = LocalCalendar::open("Etc/UTC").value();
  const auto begin = sys_days{year{2021} / 6 / 1};
  std::vector<ModelOutput> outputs{{"a", {{"a", 1.0}}, true}};
  const std::vector<MeterOutput> meters{{steady("a", begin, 31, 2.0)}};
  const std::vector<metering::Month> months{year{2021} / 6};
  EXPECT_DOUBLE_EQ(monthly_figures(meters, outputs, months, calendar, minutes{15})[0], 24.0);
  // The largest of 30 equal intervals with 2 %: 2.04 standard deviations above them.
  outputs.front().interval_noise = 0.02;
  EXPECT_NEAR(monthly_figures(meters, outputs, months, calendar, minutes{15})[0],
              24.0 * (1.0 + 0.02 * 2.043), 0.02);
}

// On 28 March 2021 the clock in Berlin skips an hour: the day has 92 quarters.
TEST(DailyFigures, AreOfLocalDaysAndMakeUpTheMonth) {
  using namespace std::chrono;
  const auto calendar = LocalCalendar::open("Europe/Berlin").value();
  const auto begin = sys_days{year{2021} / 3 / 1} - hours{1};
  const std::vector<ModelOutput> outputs{{"electricity", {{"a", 1.0}}, false},
                                         {"electricity", {{"a", 1.0}}, true}};
  MeterOutput rising = steady("a", begin, 31, 1.0);
  for (std::size_t i = 0; i < rising.energy_kWh.size(); ++i) {
    rising.energy_kWh[i] *= 1.0 + 1e-5 * static_cast<double>(i);
  }
  const std::vector<MeterOutput> meters{rising};
  std::vector<metering::Day> days;
  for (unsigned d = 1; d <= 31; ++d) days.push_back(year{2021} / 3 / std::chrono::day{d});
  days.push_back(year{2021} / 4 / 1);
  const auto of_days = daily_figures(meters, outputs, days, calendar, minutes{30});
  ASSERT_EQ(of_days.size(), 64u);
  EXPECT_TRUE(std::isnan(of_days[31]));  // 1 April is not there whole
  EXPECT_TRUE(std::isnan(of_days[63]));
  double sum_kWh = 0.0;
  double highest_kW = 0.0;
  for (std::size_t d = 0; d < 31; ++d) {
    sum_kWh += of_days[d];
    highest_kW = std::max(highest_kW, of_days[32 + d]);
  }
  const std::vector<metering::Month> march{year{2021} / 3};
  const auto month = monthly_figures(meters, outputs, march, calendar, minutes{30});
  EXPECT_NEAR(sum_kWh / 31.0, month[0], 1e-9);
  EXPECT_NEAR(highest_kW, month[1], 1e-9);
  EXPECT_LT(of_days[27], of_days[26]);
}

}  // namespace
}  // namespace recald::energyplus::monthly_output_test
