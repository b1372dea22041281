#include "core/model/electricity_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>

#include "core/absent.hpp"

namespace recald::model {
namespace {

using metering::Day;
using metering::Month;
using metering::MonthGrid;
using metering::MonthSlots;
using metering::Validity;
using std::chrono::days;
using std::chrono::sys_days;
using std::chrono::year;

MonthSlots quarter_hours(const char* zone, Month month) {
  const auto calendar = *metering::LocalCalendar::open(zone);
  MonthSlots slots{std::make_shared<const MonthGrid>(calendar, month, std::chrono::seconds{900},
                                                     std::chrono::seconds{0})};
  for (std::size_t i = 0; i < slots.used_kW.size(); ++i) {
    slots.used_kW[i] = static_cast<double>(i);
    slots.validity[i] = Validity::ok;
  }
  return slots;
}

const HourlyLoad& find(const std::vector<HourlyLoad>& loads, unsigned day, int hour) {
  for (const HourlyLoad& load : loads) {
    if (load.date.day() == std::chrono::day{day} && load.hour == hour) return load;
  }
  throw std::out_of_range("no such hour");
}

TEST(HourlyLoads, AreMeansOfTheHoursSlots) {
  const auto loads = hourly_loads(quarter_hours("UTC", year{2021} / 1));
  ASSERT_EQ(loads.size(), 744u);
  EXPECT_DOUBLE_EQ(find(loads, 1, 0).mean_kW, 1.5);          // slots 0 to 3
  EXPECT_DOUBLE_EQ(find(loads, 2, 3).mean_kW, 108.0 + 1.5);  // slot 96 + 12 on
  EXPECT_DOUBLE_EQ(find(loads, 2, 3).ok_share, 1.0);
  EXPECT_EQ(find(loads, 31, 23).date, Day{year{2021} / 1 / 31});
}

TEST(HourlyLoads, LeaveOutWhatWasNotMeasured) {
  MonthSlots slots = quarter_hours("UTC", year{2021} / 1);
  slots.validity[1] = Validity::filled;
  slots.validity[2] = Validity::suspect;
  for (std::size_t i = 4; i < 8; ++i) slots.validity[i] = Validity::missing;
  const auto loads = hourly_loads(slots);
  EXPECT_DOUBLE_EQ(loads[0].mean_kW, 1.5);  // (0 + 3) / 2
  EXPECT_DOUBLE_EQ(loads[0].ok_share, 0.5);
  EXPECT_TRUE(loads[0].suspect);
  EXPECT_TRUE(std::isnan(loads[1].mean_kW));
  EXPECT_DOUBLE_EQ(loads[1].ok_share, 0.0);
  EXPECT_FALSE(loads[1].suspect);
}

TEST(HourlyLoads, SkippedHourIsAbsentAndRepeatedHourIsOne) {
  const auto march = hourly_loads(quarter_hours("America/New_York", year{2021} / 3));
  EXPECT_EQ(march.size(), 31u * 24 - 1);
  EXPECT_THROW(find(march, 14, 2), std::out_of_range);
  const auto november = hourly_loads(quarter_hours("America/New_York", year{2021} / 11));
  EXPECT_EQ(november.size(), 30u * 24);
  // Eight slots from 6 · 96 + 4 on.
  EXPECT_DOUBLE_EQ(find(november, 7, 1).mean_kW, 580.0 + 3.5);
  EXPECT_DOUBLE_EQ(find(november, 7, 1).ok_share, 1.0);
}

/// Every hour of `count` days from a Monday on, as `load_kW(date, hour)` says.
template <class Load>
std::vector<HourlyLoad> every_hour(int count, Load load_kW, Day from = year{2021} / 1 / 4) {
  std::vector<HourlyLoad> loads;
  for (int d = 0; d < count; ++d) {
    const Day date{sys_days{from} + days{d}};
    for (int hour = 0; hour < 24; ++hour) {
      loads.push_back({date, hour, load_kW(date, hour), 1.0, false});
    }
  }
  return loads;
}

bool is_weekend(Day date) { return day_type(date, {}) != DayType::workday; }

// A building of our own making: 8 kW outdoors, 20 kW standby, fans 30 kW by day and 10 kW at night,
// and by day 60 kW of lights and plugs in the ratio of their installed 6 and 12 W/m².
TEST(FitProfile, FindsTheKnownParts) {
  KnownLoads known{.exterior_kW = 8.0, .lighting_W_m2 = 6.0, .plugs_W_m2 = 12.0};
  for (std::size_t i = 0; i < kDayTypes; ++i) {
    for (int hour = 0; hour < 24; ++hour) {
      const auto day = static_cast<DayType>(i);
      const bool works = day == DayType::workday && hour >= 8 && hour < 18;
      known.fans_and_pumps_kW.at(day, hour) = works ? 30.0 : 10.0;
    }
  }
  const auto loads = every_hour(70, [&](Day date, int hour) {
    const bool works = !is_weekend(date) && hour >= 8 && hour < 18;
    return 8.0 + 20.0 + (works ? 30.0 + 60.0 : 10.0);
  });
  const auto profile = fit_profile(loads, {}, known);
  ASSERT_TRUE(profile.has_value()) << profile.error().message;
  EXPECT_DOUBLE_EQ(profile->standby_kW, 20.0);
  EXPECT_DOUBLE_EQ(profile->measured_kW.at(DayType::workday, 12), 118.0);
  EXPECT_DOUBLE_EQ(profile->loads.lights_kW.at(DayType::workday, 12), 20.0);
  EXPECT_DOUBLE_EQ(profile->loads.plugs_kW.at(DayType::workday, 12), 60.0);  // 20 + 40
  EXPECT_DOUBLE_EQ(profile->loads.lights_kW.at(DayType::workday, 3), 0.0);
  EXPECT_DOUBLE_EQ(profile->loads.plugs_kW.at(DayType::workday, 3), 20.0);
  EXPECT_DOUBLE_EQ(profile->loads.plugs_kW.at(DayType::saturday, 12), 20.0);
  EXPECT_DOUBLE_EQ(profile->standard_error_kW.at(DayType::workday, 12), 0.0);
  EXPECT_EQ(profile->hours_used, 70 * 24);
  EXPECT_TRUE(profile->check.constant);
  EXPECT_FALSE(profile->check.uses_month_factors);
}

// Fans that draw more than the meter showed leave nothing for lights and plugs, but no less.
TEST(FitProfile, PartsAreNeverNegative) {
  KnownLoads known{.exterior_kW = 100.0, .lighting_W_m2 = 6.0, .plugs_W_m2 = 12.0};
  const auto profile = fit_profile(every_hour(70, [](Day, int) { return 50.0; }), {}, known);
  ASSERT_TRUE(profile.has_value());
  EXPECT_EQ(profile->standby_kW, 0.0);
  EXPECT_EQ(profile->loads.lights_kW.at(DayType::workday, 12), 0.0);
  EXPECT_EQ(profile->loads.plugs_kW.at(DayType::workday, 12), 0.0);
}

// Weekend nights read 8, 9, 10 kW from 2 to 5 h, little before and more after; an event of 100 kW
// takes two of the twenty.
TEST(FitProfile, StandbyIsTheMedianOfWeekendNights) {
  const auto load = [](Day date, int hour) {
    if (!is_weekend(date)) return 40.0;
    if (hour < 2) return 1.0;
    if (hour >= 5) return 25.0;
    const bool event = date == Day{year{2021} / 1 / 9} || date == Day{year{2021} / 1 / 10};
    return event ? 100.0 : 6.0 + hour;
  };
  const auto profile =
      fit_profile(every_hour(70, load), {}, {.lighting_W_m2 = 1.0, .plugs_W_m2 = 1.0});
  ASSERT_TRUE(profile.has_value());
  EXPECT_DOUBLE_EQ(profile->standby_kW, 9.0);
}

// Ten Saturdays read 1, 2, … 9 and 1000 kW: a tenth of them goes at each end, 2 … 9 stay.
TEST(FitProfile, SingleWildDaysDoNotMoveTheMean) {
  const auto profile = fit_profile(
      every_hour(70,
                 [](Day date, int) {
                   if (day_type(date, {}) != DayType::saturday) return 5.5;
                   const auto week = (sys_days{date} - sys_days{year{2021} / 1 / 4}).count() / 7;
                   return week == 9 ? 1000.0 : static_cast<double>(week + 1);
                 }),
      {}, {.lighting_W_m2 = 1.0, .plugs_W_m2 = 1.0});
  ASSERT_TRUE(profile.has_value());
  EXPECT_DOUBLE_EQ(profile->measured_kW.at(DayType::saturday, 7), 5.5);
}

// Weeks 1 … 8 read 1 … 8 kW on all their days: variance of the weekly means 6, of their mean 6/8.
TEST(FitProfile, StandardErrorCountsWeeksNotDays) {
  const auto profile = fit_profile(
      every_hour(56,
                 [](Day date, int) {
                   return 1.0 + static_cast<double>(
                                    (sys_days{date} - sys_days{year{2021} / 1 / 4}).count() / 7);
                 }),
      {}, {.lighting_W_m2 = 1.0, .plugs_W_m2 = 1.0});
  ASSERT_TRUE(profile.has_value());
  for (const DayType day : {DayType::workday, DayType::saturday, DayType::sunday_or_holiday}) {
    EXPECT_NEAR(profile->standard_error_kW.at(day, 7), std::sqrt(6.0 / 8.0), 1e-12);
  }
}

TEST(FitProfile, HolidaysRunLikeSundays) {
  const Holidays holidays = {year{2021} / 1 / 18};  // a Monday
  const auto load = [&](Day date, int) {
    return day_type(date, holidays) == DayType::workday ? 50.0 : 10.0;
  };
  const KnownLoads known{.lighting_W_m2 = 1.0, .plugs_W_m2 = 1.0};
  const auto profile = fit_profile(every_hour(70, load), holidays, known);
  ASSERT_TRUE(profile.has_value());
  EXPECT_DOUBLE_EQ(profile->standard_error_kW.at(DayType::workday, 12), 0.0);
  EXPECT_DOUBLE_EQ(profile->standard_error_kW.at(DayType::sunday_or_holiday, 12), 0.0);
}

TEST(FitProfile, TooFewHoursIsOneSentence) {
  auto loads = every_hour(56, [](Day, int) { return 10.0; });
  // The last Sunday at 5 h is half a value: three of four quarter hours are missing.
  for (HourlyLoad& load : loads) {
    if (load.date == Day{year{2021} / 2 / 28} && load.hour == 5) load.ok_share = 0.25;
  }
  const auto profile = fit_profile(loads, {}, {});
  ASSERT_FALSE(profile.has_value());
  EXPECT_EQ(profile.error().code, ErrorCode::not_enough_data);
  EXPECT_EQ(profile.error().message,
            "the electricity meter has only 7 valid hours at 5 h on days of kind "
            "sunday_or_holiday; a load profile needs at least 8 of each hour");
  // A blank hour counts as little.
  for (HourlyLoad& load : loads) {
    if (load.ok_share < 1.0) load = {load.date, load.hour, kAbsent, 1.0, false};
  }
  EXPECT_FALSE(fit_profile(loads, {}, {}).has_value());
  EXPECT_FALSE(fit_profile({}, {}, {}).has_value());
}

TEST(FitProfile, ConstantYearSaysSo) {
  const auto loads = every_hour(
      365, [](Day, int hour) { return 30.0 + hour; }, year{2021} / 1 / 1);
  const auto profile = fit_profile(loads, {}, {.lighting_W_m2 = 1.0, .plugs_W_m2 = 1.0});
  ASSERT_TRUE(profile.has_value());
  EXPECT_NEAR(profile->check.monthly_cvrmse, 0.0, 1e-12);
  EXPECT_EQ(profile->check.words,
            "One load profile predicts the electricity of 12 months within 0.0 % (CV(RMSE) of the "
            "months).");
  for (const double factor : profile->loads.month_factor) EXPECT_EQ(factor, 1.0);
}

// A school whose lights and plugs rest in July and August. With its factor each month's profile
// has the month's energy exactly, the 10 kW outdoors staying as they are.
TEST(FitProfile, SeasonalYearGetsMonthFactors) {
  const auto loads = every_hour(
      334,
      [](Day date, int) {
        const unsigned month = static_cast<unsigned>(date.month());
        return 10.0 + (month == 7 || month == 8 ? 20.0 : 50.0);
      },
      year{2021} / 1 / 1);
  const KnownLoads known{.exterior_kW = 10.0, .lighting_W_m2 = 1.0, .plugs_W_m2 = 1.0};
  const auto profile = fit_profile(loads, {}, known);
  ASSERT_TRUE(profile.has_value());
  EXPECT_FALSE(profile->check.constant);
  EXPECT_TRUE(profile->check.uses_month_factors);
  EXPECT_GT(profile->check.monthly_cvrmse, 0.05);
  EXPECT_NE(profile->check.words.find("The load profile is not constant over the year"),
            std::string::npos);
  std::array<double, 12> measured_kWh{};
  std::array<double, 12> profile_kWh{};
  for (const HourlyLoad& load : loads) {
    const auto month = static_cast<unsigned>(load.date.month()) - 1;
    const DayType day = day_type(load.date, {});
    measured_kWh[month] += load.mean_kW;
    profile_kWh[month] += known.exterior_kW + profile->loads.month_factor[month] *
                                                  (profile->loads.lights_kW.at(day, load.hour) +
                                                   profile->loads.plugs_kW.at(day, load.hour));
  }
  for (std::size_t month = 0; month < 11; ++month) {
    EXPECT_NEAR(profile_kWh[month], measured_kWh[month], 1e-6 * measured_kWh[month]) << month;
  }
  EXPECT_NEAR(profile->loads.month_factor[6] / profile->loads.month_factor[0], 0.4, 0.01);
  EXPECT_EQ(profile->loads.month_factor[11], 1.0);  // December is not in the record
}

}  // namespace
}  // namespace recald::model
