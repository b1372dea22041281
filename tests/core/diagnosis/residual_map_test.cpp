#include "core/diagnosis/evidence/residual_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sample_building.hpp"

namespace recald::diagnosis::residual_map_test {
namespace {

/// Three months of day parts, two meters that read 100 and 50 kW throughout. January 2021 begins on
/// a Friday, so part of the week 30 is its first one; in March a part has three hours.
SiteProblem steady_site() {
  SiteProblem site;
  site.nominal = testing::sample_building();
  site.drivers = std::make_shared<const model::Drivers>(testing::sample_drivers(site.nominal, 3));
  site.day_parts = make_day_parts(*site.drivers);
  site.measured_parts_kW = Eigen::ArrayXXd::Constant(site.day_parts.count(), 2, 100.0);
  site.measured_parts_kW.col(1) = 50.0;
  return site;
}

Eigen::ArrayXXd constant_kW(const SiteProblem& site, double kW) {
  return Eigen::ArrayXXd::Constant(site.day_parts.count(), 2, kW);
}

TEST(ResidualShares, AreMeasuredMinusModelledOverTheMetersMean) {
  const SiteProblem site = steady_site();
  const Eigen::ArrayXXd shares = residual_shares(site, constant_kW(site, 60.0));
  EXPECT_NEAR(shares(0, 0), 0.4, 1e-12);
  EXPECT_NEAR(shares(0, 1), -0.2, 1e-12);
}

TEST(ResidualShares, AreNothingWhereNothingWasMeasured) {
  SiteProblem site = steady_site();
  site.measured_parts_kW(3, 0) = std::nan("");
  const Eigen::ArrayXXd shares = residual_shares(site, constant_kW(site, 60.0));
  EXPECT_TRUE(std::isnan(shares(3, 0)));
  EXPECT_FALSE(std::isnan(shares(3, 1)));
  const Eigen::ArrayXXd change = change_shares(site, constant_kW(site, 10.0));
  EXPECT_TRUE(std::isnan(change(3, 0)));
  EXPECT_NEAR(change(4, 0), 0.1, 1e-12);
}

// A meter that never moved, or was never read, has no mean to be a share of.
TEST(ResidualShares, HaveNoScaleWithoutAMean) {
  SiteProblem site = steady_site();
  site.measured_parts_kW.col(0) = 0.0;
  site.measured_parts_kW.col(1) = std::nan("");
  EXPECT_TRUE(residual_shares(site, constant_kW(site, 60.0)).isNaN().all());
}

TEST(TemperatureLimits, HoldEveryPartInAFewWholeDegrees) {
  const SiteProblem site = steady_site();
  const std::vector<double> limits = temperature_limits_C(site.day_parts);
  ASSERT_GE(limits.size(), 3u);
  EXPECT_LE(limits.size(), 15u);
  for (const double limit : limits) EXPECT_EQ(limit, std::round(limit));
  for (const DayPart& part : site.day_parts.parts) {
    EXPECT_GE(part.dry_bulb_C, limits.front());
    EXPECT_LT(part.dry_bulb_C, limits.back());
  }
  EXPECT_TRUE(temperature_limits_C({}).empty());
}

TEST(TemperatureLimits, OneTemperatureIsOneBin) {
  SiteProblem site = steady_site();
  for (DayPart& part : site.day_parts.parts) part.dry_bulb_C = 20.0;
  EXPECT_EQ(temperature_limits_C(site.day_parts), (std::vector<double>{20.0, 21.0}));
}

TEST(ResidualMap, PutsAPartIntoItsWeekAndMonth) {
  const SiteProblem site = steady_site();
  Eigen::ArrayXd shares = Eigen::ArrayXd::Zero(site.day_parts.count());
  for (Eigen::Index i = 0; i < shares.size(); ++i) {
    const DayPart& part = site.day_parts.parts[static_cast<std::size_t>(i)];
    if (part.part_of_week == 30 && part.month == 1) shares[i] = 0.3;
  }
  const auto limits = temperature_limits_C(site.day_parts);
  const ResidualMap map = residual_map(site.day_parts, shares, 3, limits);
  ASSERT_EQ(map.by_month.rows(), 42);
  ASSERT_EQ(map.by_month.cols(), 3);
  EXPECT_NEAR(map.by_month(30, 1), 0.3, 1e-12);
  EXPECT_EQ(map.by_month(30, 0), 0.0);
  EXPECT_NEAR(map.by_month.sum(), 0.3, 1e-12);
  EXPECT_EQ(map.by_temperature.rows(), 6);
  EXPECT_EQ(map.by_temperature.cols(), std::ssize(limits) - 1);
}

// All in one bin: the hour-weighted mean of the column, as here computed by hand.
TEST(Signature, IsAMeanByHours) {
  const SiteProblem site = steady_site();
  Eigen::ArrayXd shares(site.day_parts.count());
  double sum = 0.0;
  double hours = 0.0;
  for (Eigen::Index i = 0; i < shares.size(); ++i) {
    const DayPart& part = site.day_parts.parts[static_cast<std::size_t>(i)];
    shares[i] = std::sin(0.37 * static_cast<double>(i)) + 0.01 * part.dry_bulb_C;
    sum += part.hours * shares[i];
    hours += part.hours;
  }
  const Signature one_bin = signature_of(site.day_parts, shares, {-50.0, 50.0});
  ASSERT_EQ(one_bin.by_temperature.size(), 1);
  EXPECT_NEAR(one_bin.by_temperature[0], sum / hours, 1e-12);
}

TEST(ResidualMap, LeavesCellsEmptyThatNothingFilled) {
  const SiteProblem site = steady_site();
  Eigen::ArrayXd shares = Eigen::ArrayXd::Constant(site.day_parts.count(), 0.1);
  for (Eigen::Index i = 0; i < shares.size(); ++i) {
    if (site.day_parts.parts[static_cast<std::size_t>(i)].month == 0) shares[i] = std::nan("");
  }
  const auto limits = temperature_limits_C(site.day_parts);
  const ResidualMap map = residual_map(site.day_parts, shares, 3, limits);
  EXPECT_TRUE(map.by_month.col(0).isNaN().all());
  EXPECT_LT((map.by_month.col(1) - 0.1).abs().maxCoeff(), 1e-12);
}

TEST(Signature, SeparatesNightsFromDays) {
  const SiteProblem site = steady_site();
  Eigen::ArrayXd shares(site.day_parts.count());
  for (Eigen::Index i = 0; i < shares.size(); ++i) {
    shares[i] = site.day_parts.parts[static_cast<std::size_t>(i)].part == 0 ? 0.2 : -0.1;
  }
  const Signature signature =
      signature_of(site.day_parts, shares, temperature_limits_C(site.day_parts));
  ASSERT_EQ(signature.by_part_of_week.size(), 42);
  EXPECT_NEAR(signature.by_part_of_week[0], 0.2, 1e-12);
  EXPECT_NEAR(signature.by_part_of_week[6], 0.2, 1e-12);
  EXPECT_NEAR(signature.by_part_of_week[1], -0.1, 1e-12);
}

}  // namespace
}  // namespace recald::diagnosis::residual_map_test
