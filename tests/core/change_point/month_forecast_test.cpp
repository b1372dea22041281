#include "core/change_point/month_forecast.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <span>

#include "tests/core/change_point/simulated_meter.hpp"

namespace recald::change_point::month_forecast_test {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

constexpr std::size_t kTwoYears = 730;
const double kMissing = std::numeric_limits<double>::quiet_NaN();

double mean_of(std::span<const MeterDay> days, metering::Month month) {
  double sum = 0.0;
  int count = 0;
  for (const MeterDay& day : days) {
    if (day.date.year() / day.date.month() != month) continue;
    sum += day.energy_kWh;
    ++count;
  }
  return sum / count;
}

/// Any form, slope, level and noise.
SimulatedMeter any_meter(Rng& rng) {
  constexpr double kSlope_kWh_K = 40.0;
  Curve curve;
  const auto form = static_cast<Form>(rng.below(kForms));
  const double balance = rng.uniform(5.0, 14.0);
  if (form != Form::no_temperature && form != Form::cooling_3p) {
    curve.heating_balance_C = balance;
    curve.heating_slope_kWh_K = rng.uniform(0.1, 1.0) * kSlope_kWh_K;
  }
  if (form != Form::no_temperature && form != Form::heating_3p) {
    const double dead_band = form == Form::two_slopes_5p ? rng.uniform(2.0, 8.0) : 0.0;
    curve.cooling_balance_C = balance + dead_band;
    curve.cooling_slope_kWh_K = rng.uniform(0.1, 1.0) * kSlope_kWh_K;
  }
  curve.form = form;
  SimulatedMeter meter = meter_with(curve);
  if (rng.uniform() < 0.3) meter.closed = {};
  meter.day_sd_kWh = rng.uniform(20.0, 100.0);
  meter.day_correlation = rng.uniform(0.0, 0.7);
  meter.month_sd_kWh = meter.day_sd_kWh * rng.uniform(0.0, 0.6);
  return meter;
}

struct Coverage {
  double months;     ///< Share inside 90 % bands.
  double months_se;  ///< By how the share scatters between buildings, whose months err together.
  int years;         ///< Buildings whose year's sum is inside.
};

/// The year after the training days, of `buildings` buildings.
Coverage coverage_after(std::size_t training_days, int buildings) {
  constexpr double kBand = 1.6449;
  Coverage coverage{};
  double squares = 0.0;
  for (int seed = 1; seed <= buildings; ++seed) {
    Rng rng{static_cast<std::uint64_t>(seed), 1};
    const std::vector<MeterDay> days =
        simulate(any_meter(rng), static_cast<int>(training_days) + 365, rng);
    const auto fit = fit_regression(std::span{days}.first(training_days));
    const auto forecast = forecast_months(fit.value(), std::span{days}.subspan(training_days));
    const auto m = std::ssize(forecast->months);
    Eigen::VectorXd error(m);
    Eigen::VectorXd weights(m);
    double inside = 0.0;
    for (Eigen::Index k = 0; k < m; ++k) {
      const auto at = static_cast<std::size_t>(k);
      error(k) = mean_of(std::span{days}.subspan(training_days), forecast->months[at]) -
                 forecast->daily_average_kWh(k);
      weights(k) = forecast->days[at];
      const double sd = std::sqrt(forecast->covariance_kWh2(k, k));
      if (std::abs(error(k)) < kBand * sd) inside += 1.0 / static_cast<double>(m);
    }
    const double year_sd = std::sqrt(weights.dot(forecast->covariance_kWh2 * weights));
    if (std::abs(weights.dot(error)) < kBand * year_sd) ++coverage.years;
    coverage.months += inside / buildings;
    squares += inside * inside / buildings;
  }
  const double variance = squares - coverage.months * coverage.months;
  coverage.months_se = std::sqrt(variance / (buildings - 1));
  return coverage;
}

// A year's sum is one trial a building: 90 % of 200 with three standard errors is 167 to 193.
TEST(MonthForecast, BandsOfMonthsAndYearsHoldTheirShare) {
  const Coverage coverage = coverage_after(kTwoYears, 200);
  EXPECT_NEAR(coverage.months, 0.9, 3.0 * coverage.months_se);
  EXPECT_GE(coverage.years, 167);
  EXPECT_LE(coverage.years, 193);
}

// January to March show no summer: bands are to be wide there, and no less than their share inside.
TEST(MonthForecast, BandsLearntInOneWinterHoldTheYear) {
  const Coverage coverage = coverage_after(90, 200);
  EXPECT_GE(coverage.months, 0.9 - 3.0 * coverage.months_se);
  EXPECT_GE(coverage.years, 167);
}

TEST(MonthForecast, TheCovarianceIsSymmetricAndPositiveDefinite) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng{seed, 2};
    const std::vector<MeterDay> days = simulate(any_meter(rng), 1095, rng);
    const std::span<const MeterDay> all{days};
    const auto fit = fit_regression(all.first(kTwoYears));
    ASSERT_TRUE(fit.has_value());
    const auto forecast = forecast_months(*fit, all.subspan(kTwoYears));
    ASSERT_TRUE(forecast.has_value());
    const Eigen::MatrixXd& covariance = forecast->covariance_kWh2;
    EXPECT_EQ(covariance, covariance.transpose());
    EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(covariance).info(), Eigen::Success);
  }
}

// A plant that is off: nothing varies, and nothing may divide by it.
TEST(MonthForecast, AMeterThatStandsStillHasANarrowBandAndNotNone) {
  Rng rng{9, 2};
  std::vector<MeterDay> days = simulate({}, 1095, rng);
  for (MeterDay& day : days) day.energy_kWh = 0.0;
  const std::span<const MeterDay> all{days};
  const auto fit = fit_regression(all.first(kTwoYears));
  ASSERT_TRUE(fit.has_value());
  const auto forecast = forecast_months(*fit, all.subspan(kTwoYears));
  ASSERT_TRUE(forecast.has_value());
  EXPECT_THAT(forecast->daily_average_kWh, Each(0.0));
  const Eigen::LLT<Eigen::MatrixXd> factor{forecast->covariance_kWh2};
  EXPECT_EQ(factor.info(), Eigen::Success);
  EXPECT_LT(forecast->covariance_kWh2.maxCoeff(), 1e-6);
}

/// One base load, sd 10 kWh at every level, correlation 0.5.
Regression flat_by_hand() {
  Regression regression{};
  regression.base_kWh = {100.0, 100.0, 100.0};
  regression.curves = {Curve{}};
  regression.parameter_covariance = Eigen::MatrixXd::Constant(1, 1, 4.0);
  regression.scatter = ScatterByLevel{std::array{0.0}, std::array{0.0}, 10.0};
  regression.day_correlation = 0.5;
  regression.month_variance = 0.09;
  regression.widening = 1.21;
  regression.mean_kWh = 90.0;
  regression.coldest_C = 5.0;
  regression.warmest_C = 25.0;
  return regression;
}

std::vector<MeterDay> days_from(std::chrono::sys_days first, int count, double dry_bulb_C) {
  std::vector<MeterDay> days;
  for (int i = 0; i < count; ++i) {
    const metering::Day date{first + std::chrono::days{i}};
    days.push_back({date, model::day_type(date, {}), kMissing, dry_bulb_C});
  }
  return days;
}

// 30 June and 1, 2 July by hand. June is one day: 4 + 100 + 0.09 * 100. Of the two days in July the
// mean has 4 + 100 (1 + 0.5) / 2 + 9. Both share the base load, and neighbouring days:
// 4 + 100 (0.5 + 0.25) / 2. All times 1.21.
TEST(MonthForecast, TheCovarianceByHand) {
  const std::vector<MeterDay> days =
      days_from(std::chrono::sys_days{std::chrono::year{2022} / 6 / 30}, 3, 20.0);
  const auto forecast = forecast_months(flat_by_hand(), days);
  ASSERT_TRUE(forecast.has_value());
  EXPECT_EQ(forecast->days, (std::vector{1, 2}));
  EXPECT_NEAR(forecast->daily_average_kWh(1), 100.0, 1e-12);
  EXPECT_NEAR(forecast->covariance_kWh2(0, 0), 1.21 * 113.0, 1e-9);
  EXPECT_NEAR(forecast->covariance_kWh2(1, 1), 1.21 * 88.0, 1e-9);
  EXPECT_NEAR(forecast->covariance_kWh2(0, 1), 1.21 * 41.5, 1e-9);
}

// As above, but 10 K too cold: a slope with an sd of 90 kWh / 30 K adds 30 kWh to both, squared.
// The slope beyond the other end is another one.
TEST(MonthForecast, BeyondTrainingASlopeIsNotKnown) {
  std::vector<MeterDay> days =
      days_from(std::chrono::sys_days{std::chrono::year{2022} / 6 / 30}, 3, -5.0);
  const auto cold = forecast_months(flat_by_hand(), days);
  ASSERT_TRUE(cold.has_value());
  EXPECT_EQ(cold->days_beyond, (std::vector{1, 2}));
  EXPECT_NEAR(cold->covariance_kWh2(0, 0), 1.21 * (113.0 + 900.0), 1e-9);
  EXPECT_NEAR(cold->covariance_kWh2(0, 1), 1.21 * (41.5 + 900.0), 1e-9);
  days[0].dry_bulb_C = 30.0;
  const auto mixed = forecast_months(flat_by_hand(), days);
  ASSERT_TRUE(mixed.has_value());
  EXPECT_NEAR(mixed->covariance_kWh2(0, 0), 1.21 * (113.0 + 225.0), 1e-9);
  EXPECT_NEAR(mixed->covariance_kWh2(0, 1), 1.21 * 41.5, 1e-9);
}

TEST(MonthForecast, WithoutASlopeNoTemperatureIsNeeded) {
  const std::vector<MeterDay> days =
      days_from(std::chrono::sys_days{std::chrono::year{2022} / 6 / 1}, 30, kMissing);
  const auto forecast = forecast_months(flat_by_hand(), days);
  ASSERT_TRUE(forecast.has_value());
  EXPECT_THAT(forecast->days_beyond, Each(0));
}

class ForecastOfASlope : public ::testing::Test {
 protected:
  ForecastOfASlope() {
    Rng rng{4, 3};
    days_ = simulate(meter_with(curve_3p_heating()), 1095, rng);
    fit_ = fit_regression(std::span{days_}.first(kTwoYears)).value();
  }

  std::vector<MeterDay> days_;
  Regression fit_;
};

TEST_F(ForecastOfASlope, ADayWithoutATemperatureIsLikeItsMonthAndLessSure) {
  std::vector<MeterDay> january(days_.begin() + 730, days_.begin() + 761);
  double mean = 0.0;
  for (std::size_t i = 10; i < 31; ++i) mean += january[i].dry_bulb_C / 21.0;
  std::vector<MeterDay> filled = january;
  for (std::size_t i = 0; i < 10; ++i) {
    january[i].dry_bulb_C = kMissing;
    filled[i].dry_bulb_C = mean;
  }
  const auto gappy = forecast_months(fit_, january);
  const auto whole = forecast_months(fit_, filled);
  ASSERT_TRUE(gappy.has_value() && whole.has_value());
  EXPECT_NEAR(gappy->daily_average_kWh(0), whole->daily_average_kWh(0), 1e-9);
  // Ten of 31 days may be one sd of the known days colder: 30 kWh/K * sd * 10 / 31.
  double squares = 0.0;
  for (std::size_t i = 10; i < 31; ++i) squares += std::pow(january[i].dry_bulb_C - mean, 2) / 20.0;
  const double weather = fit_.curves[0].heating_slope_kWh_K * std::sqrt(squares) * 10.0 / 31.0;
  EXPECT_NEAR(gappy->covariance_kWh2(0, 0) - whole->covariance_kWh2(0, 0),
              fit_.widening * weather * weather, 1e-6);
}

TEST_F(ForecastOfASlope, AMonthMostlyWithoutTemperaturesIsRefused) {
  std::vector<MeterDay> january(days_.begin() + 730, days_.begin() + 761);
  for (std::size_t i = 0; i < 16; ++i) january[i].dry_bulb_C = kMissing;
  const auto refused = forecast_months(fit_, january);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::not_enough_data);
  EXPECT_THAT(refused.error().message, HasSubstr("known on 15 of 31 days of 2023-01"));
}

TEST_F(ForecastOfASlope, DaysBeyondTrainingAreCounted) {
  const std::chrono::sys_days june{std::chrono::year{2023} / 6 / 1};
  const auto usual = forecast_months(fit_, days_from(june, 30, fit_.coldest_C));
  const auto far = forecast_months(fit_, days_from(june, 30, fit_.coldest_C - 0.1));
  ASSERT_TRUE(usual.has_value() && far.has_value());
  EXPECT_THAT(usual->days_beyond, Each(0));
  EXPECT_THAT(far->days_beyond, Each(30));
}

const LeftOutMonth& month_of(const std::vector<LeftOutMonth>& months, metering::Month month) {
  return *std::ranges::find(months, month, &LeftOutMonth::month);
}

TEST(LeftOutMonths, AMonthDoesNotSeeItself) {
  Rng rng{5, 4};
  const std::vector<MeterDay> days = simulate(meter_with(curve_5p()), 730, rng);
  const metering::Month march = std::chrono::year{2022} / std::chrono::March;
  std::vector<MeterDay> changed = days;
  for (MeterDay& day : changed) {
    if (day.date.year() / day.date.month() == march) day.energy_kWh *= 1.3;
  }
  const auto before = forecast_left_out_months(days);
  const auto after = forecast_left_out_months(changed);
  ASSERT_TRUE(before.has_value() && after.has_value());
  ASSERT_EQ(before->size(), 24);
  EXPECT_EQ(month_of(*before, march).daily_average_kWh, month_of(*after, march).daily_average_kWh);
  EXPECT_EQ(month_of(*before, march).sd_kWh, month_of(*after, march).sd_kWh);
  const metering::Month april = std::chrono::year{2022} / std::chrono::April;
  EXPECT_NE(month_of(*before, april).daily_average_kWh, month_of(*after, april).daily_average_kWh);
}

TEST(LeftOutMonths, MonthsLeftOutTogetherDoNotSeeEachOther) {
  Rng rng{6, 4};
  const std::vector<MeterDay> days = simulate(meter_with(curve_5p()), 730, rng);
  std::vector<MeterDay> changed = days;
  const metering::Month april = std::chrono::year{2021} / std::chrono::April;
  const metering::Month june = std::chrono::year{2021} / std::chrono::June;
  for (MeterDay& day : changed) {
    if (day.date.year() / day.date.month() == april) day.energy_kWh *= 1.3;
  }
  const auto before = forecast_left_out_months(days, 3);
  const auto after = forecast_left_out_months(changed, 3);
  ASSERT_TRUE(before.has_value() && after.has_value());
  ASSERT_EQ(before->size(), 24);
  EXPECT_EQ(month_of(*before, june).daily_average_kWh, month_of(*after, june).daily_average_kWh);
  const metering::Month july = std::chrono::year{2021} / std::chrono::July;
  EXPECT_NE(month_of(*before, july).daily_average_kWh, month_of(*after, july).daily_average_kWh);
}

// 80 days: without any of the three months too few are left.
TEST(LeftOutMonths, SaysWhyWhereNoneCanBeForecast) {
  Rng rng{7, 4};
  const auto refused = forecast_left_out_months(simulate(meter_with(curve_5p()), 80, rng));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::not_enough_data);
}

// Usable are 19 days of January, 14 of February, 31 of March and 10 of April: 60 or more are left
// without February and without April.
TEST(LeftOutMonths, LeavesOutWhatTheOthersCannotForecast) {
  Rng rng{8, 4};
  std::vector<MeterDay> days = simulate(meter_with(curve_5p()), 100, rng);
  for (std::size_t i = 0; i < 12; ++i) days[i].energy_kWh = kMissing;
  for (std::size_t i = 31; i < 45; ++i) days[i].energy_kWh = kMissing;
  const auto months = forecast_left_out_months(days);
  ASSERT_TRUE(months.has_value());
  ASSERT_EQ(months->size(), 2);
  EXPECT_EQ(months->at(0).month, std::chrono::year{2021} / std::chrono::February);
  EXPECT_EQ(months->at(1).month, std::chrono::year{2021} / std::chrono::April);
}

}  // namespace
}  // namespace recald::change_point::month_forecast_test
