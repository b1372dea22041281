#include "core/profile/load_band.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/absent.hpp"
#include "core/random/rng.hpp"

namespace recald::profile::load_band_test {
namespace {

using model::DayType;

/// A year of a building that the model has 10 kW too low by day and right at night, with noise that
/// grows with the load.
std::vector<ModelledHour> year(std::uint64_t seed, double workday_more_kW = 0.0) {
  Rng rng{seed, 0};
  std::vector<ModelledHour> hours;
  for (int day = 0; day < 365; ++day) {
    const DayType kind = day % 7 == 5   ? DayType::saturday
                         : day % 7 == 6 ? DayType::sunday_or_holiday
                                        : DayType::workday;
    for (int hour = 0; hour < 24; ++hour) {
      const bool is_day = hour >= 8 && hour < 18 && kind == DayType::workday;
      const double modelled = (is_day ? 60.0 : 20.0) + 20.0 * rng.uniform();
      const double error = (is_day ? 10.0 + workday_more_kW : 0.0) + 0.05 * modelled * rng.normal();
      hours.push_back({kind, hour, modelled, modelled + error});
    }
  }
  return hours;
}

TEST(LoadBand, HoldsNineOfTenHoursThatItHasNotSeen) {
  const LoadBand band{year(1)};
  int inside = 0;
  int all = 0;
  for (const ModelledHour& hour : year(2)) {
    const auto expected = band.at(hour.day, hour.local_hour, hour.modelled_kW);
    ASSERT_TRUE(expected.has_value());
    ++all;
    if (expected->q05_kW <= hour.measured_kW && hour.measured_kW <= expected->q95_kW) ++inside;
  }
  EXPECT_NEAR(static_cast<double>(inside) / all, 0.9, 0.03);
}

TEST(LoadBand, HasTheModelsHabitualErrorInIt) {
  const LoadBand band{year(1)};
  EXPECT_NEAR(band.at(DayType::workday, 12, 70.0)->q50_kW, 80.0, 1.0);
  EXPECT_NEAR(band.at(DayType::workday, 3, 30.0)->q50_kW, 30.0, 0.5);
  EXPECT_NEAR(band.at(DayType::saturday, 12, 30.0)->q50_kW, 30.0, 0.5);
}

TEST(LoadBand, AMeterThatNeverRanBackwardsIsNotExpectedTo) {
  auto hours = year(1);
  for (ModelledHour& hour : hours) hour.measured_kW = std::max(0.0, hour.measured_kW - 40.0);
  EXPECT_EQ(LoadBand{hours}.at(DayType::saturday, 3, 20.0)->q05_kW, 0.0);
}

TEST(LoadBand, ALoadThatIsNewIsOutside) {
  const LoadBand band{year(1)};
  int outside = 0;
  int all = 0;
  for (const ModelledHour& hour : year(2, 15.0)) {
    if (hour.day != DayType::workday || hour.local_hour < 9 || hour.local_hour > 16) continue;
    ++all;
    if (hour.measured_kW > band.at(hour.day, hour.local_hour, hour.modelled_kW)->q95_kW) ++outside;
  }
  EXPECT_GT(outside, 9 * all / 10);
}

TEST(LoadBand, OfAFewDaysThereIsNone) {
  auto few = year(1);
  few.resize(24 * 10);
  EXPECT_FALSE(LoadBand{few}.at(DayType::workday, 12, 70.0).has_value());
  for (ModelledHour& hour : few) hour.measured_kW = kAbsent;
  EXPECT_FALSE(LoadBand{few}.at(DayType::workday, 12, 70.0).has_value());
}

}  // namespace
}  // namespace recald::profile::load_band_test
