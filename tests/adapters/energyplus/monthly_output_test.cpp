#include "adapters/energyplus/monthly_output.hpp"

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

}  // namespace
}  // namespace recald::energyplus::monthly_output_test
