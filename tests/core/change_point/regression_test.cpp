#include "core/change_point/regression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "tests/core/change_point/simulated_meter.hpp"

namespace recald::change_point::regression_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kTwoYears = 730;
const double kMissing = std::numeric_limits<double>::quiet_NaN();

std::vector<MeterDay> two_years(const SimulatedMeter& meter, std::uint64_t seed) {
  Rng rng{seed, 0};
  return simulate(meter, kTwoYears, rng);
}

/// Truth in the order of the parameters.
std::vector<double> parameters(const std::array<double, 3>& base_kWh, const Curve& curve) {
  std::vector<double> values{base_kWh.begin(), base_kWh.end()};
  if (curve.form == Form::two_slopes_4p) {
    values.insert(values.end(),
                  {curve.heating_slope_kWh_K, curve.cooling_slope_kWh_K, curve.heating_balance_C});
    return values;
  }
  if (!std::isnan(curve.heating_balance_C)) {
    values.insert(values.end(), {curve.heating_slope_kWh_K, curve.heating_balance_C});
  }
  if (!std::isnan(curve.cooling_balance_C)) {
    values.insert(values.end(), {curve.cooling_slope_kWh_K, curve.cooling_balance_C});
  }
  return values;
}

// Over many seeds the form is found, and each parameter lies within 1.645 of its standard errors in
// 90 % of the cases, to 3.5 binomial standard errors (there are 23 parameters).
TEST(ChangePointRegression, FindsFormAndParametersWithinTheirStandardErrors) {
  constexpr int kSeeds = 150;
  for (const Curve& truth : {curve_3p_heating(), curve_3p_cooling(), curve_4p(), curve_5p()}) {
    SCOPED_TRACE(kFormNames[static_cast<std::size_t>(truth.form)]);
    SimulatedMeter meter = meter_with(truth);
    meter.month_sd_kWh = 15.0;
    const std::vector<double> expected = parameters(meter.base_kWh, truth);
    std::vector<int> inside(expected.size(), 0);
    int found = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const auto fit = fit_regression(two_years(meter, seed));
      ASSERT_TRUE(fit.has_value()) << fit.error().message;
      const bool has_the_form = fit->curves.size() == 1 && fit->curves[0].form == truth.form &&
                                fit->base_number == std::array{0, 1, 2};
      if (!has_the_form) continue;
      ++found;
      const std::vector<double> values = parameters(fit->base_kWh, fit->curves[0]);
      for (std::size_t k = 0; k < values.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        const double sd = std::sqrt(fit->parameter_covariance(at, at));
        if (std::abs(values[k] - expected[k]) < 1.645 * sd) ++inside[k];
      }
    }
    EXPECT_GE(found, 0.8 * kSeeds);
    for (std::size_t k = 0; k < inside.size(); ++k) {
      EXPECT_NEAR(inside[k], 0.9 * found, 3.5 * std::sqrt(0.09 * found)) << "parameter " << k;
    }
  }
}

TEST(ChangePointRegression, AFlatMeterGetsNoTemperature) {
  constexpr int kSeeds = 100;
  SimulatedMeter meter;
  meter.month_sd_kWh = 15.0;
  int flat = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto fit = fit_regression(two_years(meter, seed));
    ASSERT_TRUE(fit.has_value());
    EXPECT_THAT(fit->no_temperature_because, IsEmpty());
    if (fit->curves.size() == 1 && fit->curves[0].form == Form::no_temperature) ++flat;
  }
  EXPECT_GE(flat, 85);
}

TEST(ChangePointRegression, ClosedDaysGetACurveOfTheirOwnWhereTheyHaveOne) {
  SimulatedMeter meter = meter_with(curve_3p_heating());
  meter.closed = {};
  const auto fit = fit_regression(two_years(meter, 1));
  ASSERT_TRUE(fit.has_value());
  ASSERT_EQ(fit->curves.size(), 2);
  EXPECT_EQ(fit->curve_of, (std::array<std::size_t, 3>{0, 1, 1}));
  EXPECT_EQ(fit->curves[0].form, Form::heating_3p);
  EXPECT_NEAR(fit->curves[0].heating_slope_kWh_K, 30.0, 3.0);
  EXPECT_EQ(fit->curves[1].form, Form::no_temperature);
}

TEST(ChangePointRegression, SaturdaysMayBeOpenDays) {
  SimulatedMeter meter = meter_with(curve_3p_heating());
  meter.closed = {};
  std::vector<MeterDay> days = two_years(meter, 2);
  for (MeterDay& day : days) {
    if (day.type == model::DayType::saturday) day.energy_kWh += meter.open.at(day.dry_bulb_C);
  }
  const auto fit = fit_regression(days);
  ASSERT_TRUE(fit.has_value());
  ASSERT_EQ(fit->curves.size(), 2);
  EXPECT_EQ(fit->curve_of, (std::array<std::size_t, 3>{0, 0, 1}));
  EXPECT_EQ(fit->curves[0].form, Form::heating_3p);
  EXPECT_EQ(fit->curves[1].form, Form::no_temperature);
}

TEST(ChangePointRegression, KindsOfDayThatDoNotDifferShareABaseLoad) {
  SimulatedMeter meter = meter_with(curve_3p_heating());
  meter.base_kWh = {800.0, 800.0, 800.0};
  int shared = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto fit = fit_regression(two_years(meter, seed));
    ASSERT_TRUE(fit.has_value());
    if (fit->base_number == std::array{0, 0, 0}) ++shared;
  }
  EXPECT_GE(shared, 15);
}

// Against the same meter without: what is expected of a mild, a cold and a hot workday.
void expect_same_curve(const Regression& fit, const Regression& clean, double tolerance_kWh) {
  for (const double t : {-5.0, 5.0, 12.0, 20.0, 28.0}) {
    EXPECT_NEAR(fit.expected_kWh(model::DayType::workday, t),
                clean.expected_kWh(model::DayType::workday, t), tolerance_kWh)
        << t;
  }
}

TEST(ChangePointRegression, OutlyingDaysDoNotMoveIt) {
  const std::vector<MeterDay> clean = two_years(meter_with(curve_5p()), 3);
  std::vector<MeterDay> spoilt = clean;
  for (std::size_t i = 10; i < spoilt.size(); i += 37) spoilt[i].energy_kWh = 5000.0;
  for (std::size_t i = 20; i < spoilt.size(); i += 71) spoilt[i].energy_kWh = 0.0;
  const auto of_clean = fit_regression(clean);
  const auto of_spoilt = fit_regression(spoilt);
  ASSERT_TRUE(of_clean.has_value() && of_spoilt.has_value());
  expect_same_curve(*of_spoilt, *of_clean, 15.0);
}

TEST(ChangePointRegression, AMissingStretchDoesNotMoveIt) {
  const std::vector<MeterDay> clean = two_years(meter_with(curve_5p()), 4);
  std::vector<MeterDay> gappy = clean;
  for (std::size_t i = 100; i < 190; ++i) gappy[i].energy_kWh = kMissing;
  for (std::size_t i = 400; i < 430; ++i) gappy[i].dry_bulb_C = kMissing;
  gappy.erase(gappy.begin() + 500, gappy.begin() + 560);
  const auto of_clean = fit_regression(clean);
  const auto of_gappy = fit_regression(gappy);
  ASSERT_TRUE(of_clean.has_value() && of_gappy.has_value());
  EXPECT_EQ(of_gappy->days, kTwoYears - 180);
  expect_same_curve(*of_gappy, *of_clean, 40.0);
}

// No Sunday is usable, so what is known of Sundays and holidays comes from holidays in midweek.
TEST(ChangePointRegression, HolidaysCountAsWhatTheyAreCalled) {
  const SimulatedMeter meter = meter_with(curve_5p());
  std::vector<MeterDay> days = two_years(meter, 5);
  for (std::size_t i = 0; i < days.size(); ++i) {
    if (days[i].type == model::DayType::sunday_or_holiday) days[i].energy_kWh = kMissing;
    if (days[i].type != model::DayType::workday || i % 20 != 0) continue;
    days[i].type = model::DayType::sunday_or_holiday;
    days[i].energy_kWh += meter.base_kWh[2] - meter.base_kWh[0];
  }
  const auto fit = fit_regression(days);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->base_kWh[0], meter.base_kWh[0], 25.0);
  EXPECT_NEAR(fit->base_kWh[1], meter.base_kWh[1], 30.0);
  EXPECT_NEAR(fit->base_kWh[2], meter.base_kWh[2], 40.0);
}

TEST(ChangePointRegression, NeedsSixtyUsableDays) {
  std::vector<MeterDay> days = two_years(meter_with(curve_5p()), 6);
  days.resize(70);
  for (std::size_t i = 0; i < 11; ++i) days[5 * i].energy_kWh = kMissing;
  const auto refused = fit_regression(days);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::not_enough_data);
  EXPECT_THAT(refused.error().message, HasSubstr("needs 60 days"));
  EXPECT_THAT(refused.error().message, HasSubstr("there are 59"));
  days[0].energy_kWh = 700.0;
  EXPECT_TRUE(fit_regression(days).has_value());
}

TEST(ChangePointRegression, RefusesAnInfiniteConsumption) {
  std::vector<MeterDay> days = two_years(meter_with(curve_5p()), 7);
  days[99].energy_kWh = std::numeric_limits<double>::infinity();
  const auto refused = fit_regression(days);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::not_finite);
  EXPECT_THAT(refused.error().message, HasSubstr("consumption of 2021-04-10"));
}

TEST(ChangePointRegression, RefusesATemperatureThatIsACode) {
  for (const double code : {999.9, -99.9, -std::numeric_limits<double>::infinity()}) {
    std::vector<MeterDay> days = two_years(meter_with(curve_5p()), 7);
    days[99].dry_bulb_C = code;
    const auto refused = fit_regression(days);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
    EXPECT_THAT(refused.error().message, HasSubstr("temperature of 2021-04-10"));
  }
}

TEST(ChangePointRegression, TemperaturesTooCloseTogetherCannotSupportASlope) {
  std::vector<MeterDay> days = two_years(meter_with(curve_5p()), 8);
  for (MeterDay& day : days) day.dry_bulb_C = 26.0 + 0.05 * (day.dry_bulb_C - 11.0);
  const auto fit = fit_regression(days);
  ASSERT_TRUE(fit.has_value());
  EXPECT_THAT(fit->no_temperature_because, HasSubstr("too close together for a slope"));
  EXPECT_NEAR(fit->coldest_C, 25.2, 0.5);
  EXPECT_NEAR(fit->warmest_C, 26.8, 0.5);
  for (const Curve& curve : fit->curves) EXPECT_EQ(curve.form, Form::no_temperature);
}

TEST(ChangePointRegression, WithoutTemperaturesItIsWithoutASlope) {
  std::vector<MeterDay> days = two_years(meter_with(curve_5p()), 9);
  for (std::size_t i = 59; i < days.size(); ++i) days[i].dry_bulb_C = kMissing;
  const auto fit = fit_regression(days);
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->no_temperature_because, "only 59 of 730 usable days have a temperature");
  EXPECT_EQ(fit->days, kTwoYears);
  EXPECT_TRUE(std::isnan(fit->coldest_C) && std::isnan(fit->warmest_C));
  for (const Curve& curve : fit->curves) EXPECT_EQ(curve.form, Form::no_temperature);
}

// Seven closed days in two years are too few for a base load, however different they are.
TEST(ChangePointRegression, AKindOfDayThatIsRareCountsAsTheNext) {
  std::vector<MeterDay> days = two_years(meter_with(curve_3p_heating()), 10);
  int closed_days = 0;
  std::erase_if(days, [&](const MeterDay& day) {
    return day.type != model::DayType::workday && closed_days++ % 30 != 0;
  });
  const auto fit = fit_regression(days);
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->base_kWh[1], fit->base_kWh[0]);
  EXPECT_EQ(fit->base_kWh[2], fit->base_kWh[0]);
}

}  // namespace
}  // namespace recald::change_point::regression_test
