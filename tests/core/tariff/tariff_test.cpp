#include "core/tariff/tariff.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace recald::tariff {
namespace {

using metering::Utility;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Day and night price on workdays.
Tariff day_and_night() {
  Tariff tariff{.currency = "EUR"};
  tariff.prices[static_cast<std::size_t>(Utility::electricity)] = Prices{
      .per_kWh = 0.10,
      .periods = {{.from_hour = 7, .to_hour = 19, .days = {true, false, false}, .per_kWh = 0.30}},
      .per_kW_month = 12.0};
  tariff.emissions_kg_per_kWh[static_cast<std::size_t>(Utility::electricity)] = 0.4;
  return tariff;
}

/// June 2021 at 10 kW, but for the hours that `is_blank` names.
template <class IsBlank>
std::vector<model::HourlyLoad> june(IsBlank is_blank) {
  std::vector<model::HourlyLoad> hours;
  for (unsigned day = 1; day <= 30; ++day) {
    for (int hour = 0; hour < 24; ++hour) {
      const metering::Day date = std::chrono::year{2021} / 6 / day;
      hours.push_back({date, hour, is_blank(date, hour) ? kNaN : 10.0, 1.0, false});
    }
  }
  return hours;
}

metering::MonthlyFigure june_figure() {
  metering::MonthlyFigure figure{};
  figure.month = std::chrono::year{2021} / 6;
  figure.daily_average_kWh = 240.0;
  figure.peak = {{.kW = 25.0, .start = {}, .could_be_exceeded = false}};
  return figure;
}

TEST(Tariff, ABillPartsTheMonthAmongItsPeriods) {
  const auto hours = june([](metering::Day, int) { return false; });
  const MonthBill bill = bill_of(day_and_night(), Utility::electricity, june_figure(), hours, {});
  // 22 workdays of 12 hours at 0.30, all else at 0.10.
  const double day_kWh = 22 * 12 * 10.0;
  EXPECT_NEAR(*bill.energy, 0.30 * day_kWh + 0.10 * (7200.0 - day_kWh), 1e-9);
  EXPECT_DOUBLE_EQ(*bill.demand, 300.0);
  EXPECT_NEAR(*bill.emissions_kg, 0.4 * 7200.0, 1e-9);
}

TEST(Tariff, HolidaysAreNoWorkdays) {
  const auto hours = june([](metering::Day, int) { return false; });
  const model::Holidays holidays{std::chrono::year{2021} / 6 / 14};  // a Monday
  const auto without = bill_of(day_and_night(), Utility::electricity, june_figure(), hours, {});
  const auto with = bill_of(day_and_night(), Utility::electricity, june_figure(), hours, holidays);
  EXPECT_NEAR(*without.energy - *with.energy, 120.0 * 0.20, 1e-9);
}

TEST(Tariff, WhatWasNotMeasuredIsSharedOutAsWhatWas) {
  const auto whole = june([](metering::Day, int) { return false; });
  const auto half = june([](metering::Day date, int) {
    // Two weeks of the four and two days: as many workdays in each.
    const unsigned day = static_cast<unsigned>(date.day());
    return day >= 15 && day <= 28;
  });
  const auto mean = mean_price_per_kWh(day_and_night(), Utility::electricity, half, {});
  ASSERT_TRUE(mean);
  // 12 workdays of 16 days are left.
  EXPECT_NEAR(*mean, (12 * 12 * 0.30 + (16 * 24 - 12 * 12) * 0.10) / (16 * 24), 1e-12);
}

TEST(Tariff, WhatTheTariffDoesNotSayIsAbsent) {
  const auto hours = june([](metering::Day, int) { return false; });
  const MonthBill heat = bill_of(day_and_night(), Utility::heating, june_figure(), hours, {});
  EXPECT_FALSE(heat.energy || heat.demand || heat.emissions_kg);
  metering::MonthlyFigure without_peak = june_figure();
  without_peak.peak.reset();
  EXPECT_FALSE(bill_of(day_and_night(), Utility::electricity, without_peak, hours, {}).demand);
  EXPECT_TRUE(Tariff{}.is_empty());
  EXPECT_FALSE(day_and_night().is_empty());
}

TEST(Tariff, APeriodMayGoOverMidnight) {
  const PricePeriod night{.from_hour = 22, .to_hour = 6, .per_kWh = 0.05};
  EXPECT_TRUE(night.contains(model::DayType::workday, 23));
  EXPECT_TRUE(night.contains(model::DayType::saturday, 5));
  EXPECT_FALSE(night.contains(model::DayType::workday, 6));
}

}  // namespace
}  // namespace recald::tariff
