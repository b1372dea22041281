#include "core/assessment/spread.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/drift/watch/calibration_check.hpp"
#include "core/random/rng.hpp"

namespace recald::assessment::spread_test {
namespace {

Forecast standard_normal(Eigen::Index components) {
  return {Eigen::VectorXd::Zero(components), Eigen::VectorXd::Ones(components),
          Eigen::VectorXd::Constant(components, 1.0 / static_cast<double>(components))};
}

/// At this level the prior is that months scatter as forecast.
constexpr double kFull = 0.95;

// Nothing known yet: as wide as forecast, with four months' doubt about that, and as likely as not
// with tails of four degrees of freedom: two in all, of half the variance.
TEST(Spread, BeginsAsStudentsT) {
  const Forecast adapted = Spread{}.adapt(standard_normal(512), kFull);
  const boost::math::students_t plain{4.0}, heavy{2.0};
  for (const double x : {-2.0, -1.0, 0.3, 1.5}) {
    EXPECT_NEAR(
        adapted.cdf(x),
        0.5 * boost::math::cdf(plain, x) + 0.5 * boost::math::cdf(heavy, x * std::numbers::sqrt2),
        0.005)
        << x;
  }
  // Ten sds off is not impossible.
  const double beyond = 0.5 * boost::math::cdf(plain, -10.0) +
                        0.5 * boost::math::cdf(heavy, -10.0 * std::numbers::sqrt2);
  EXPECT_NEAR(adapted.cdf(-10.0) / beyond, 1.0, 0.1);
}

// By hand: 12 surprises of 2. All months: (6 + 48) / 18 = 3; there (4 * 3 + 48) / 16 = 15 / 4,
// known as well as by 16 months.
TEST(Spread, LearnsFromMonthsAtTheSameLevel) {
  Spread spread;
  for (int i = 0; i < 12; ++i) spread.take(kFull, i % 2 == 0 ? 2.0 : -2.0);
  EXPECT_NEAR(spread.variance_at(kFull).mean, 15.0 / 4.0, 1e-12);
  EXPECT_NEAR(spread.variance_at(kFull).months, 16.0, 1e-12);
  // Far away only what all months say is known, in proportion to the use.
  EXPECT_NEAR(spread.variance_at(0.15).mean, 0.2 * 3.0, 1e-9);
  EXPECT_NEAR(spread.variance_at(0.15).months, 4.0, 1e-9);
  EXPECT_NEAR(spread.variance_at(-0.5).mean, 0.05 * 3.0, 1e-9);
}

TEST(Spread, LearnsHowHeavyTailsAre) {
  Rng rng{3, 0};
  Spread normal, heavy;
  for (int i = 0; i < 400; ++i) {
    const double z = rng.normal();
    normal.take(kFull, z);
    heavy.take(kFull, i % 5 == 0 ? 2.2 * z : 0.4 * z);  // of variance 1.1
  }
  EXPECT_LT(normal.heavy_probability(), 0.1);
  EXPECT_GT(heavy.heavy_probability(), 0.9);
}

TEST(Spread, KeepsTheMeanAndTheShape) {
  Spread spread;
  Rng rng{4, 0};
  for (int i = 0; i < 400; ++i) spread.take(0.5, 2.0 * rng.normal());
  Forecast two = standard_normal(200);
  two.means.head(100).setConstant(3.0);
  two.means.tail(100).setConstant(5.0);
  const Forecast adapted = spread.adapt(two, 0.5);
  EXPECT_NEAR(adapted.mean(), 4.0, 1e-9);
  EXPECT_NEAR(adapted.sd() / two.sd(), 2.0, 0.15);
}

TEST(Spread, AChangeDoesNotPassForScatter) {
  Spread steady, changed;
  for (int i = 0; i < 24; ++i) {
    steady.take(0.5, 1.0);
    changed.take(0.5, i == 23 ? 50.0 : 1.0);
  }
  EXPECT_NEAR(changed.variance_at(0.5).mean - steady.variance_at(0.5).mean, 0.0, 0.6);
  EXPECT_GT(changed.variance_at(0.5).mean, steady.variance_at(0.5).mean);
}

// A year of twelve levels whose errors differ by eight times: forecasts of one spread are not true,
// those adapted to what was learnt nearly are, although it is the other way round than expected:
// what is used little scatters most.
TEST(Spread, MakesForecastsTrueWhereErrorsDependOnTheLevel) {
  Rng rng{5, 0};
  const Forecast forecast = standard_normal(128);
  std::vector<double> plain, adapted;
  for (int world = 0; world < 40; ++world) {
    Spread spread;
    for (int month = 0; month < 60; ++month) {
      const double level = 0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * month / 12.0);
      const double measured = (level < 0.5 ? 2.5 : 0.3) * rng.normal();  // not as the prior has it
      const double before = surprise_of(forecast, measured).standardised;
      if (month >= 24) {
        plain.push_back(before);
        adapted.push_back(surprise_of(spread.adapt(forecast, level), measured).standardised);
      }
      spread.take(level, before);
    }
  }
  EXPECT_LT(drift::check_calibration(plain)->pvalue, 1e-6);
  const auto check = drift::check_calibration(adapted);
  EXPECT_NEAR(check->sd, 1.0, 0.15);
}

}  // namespace
}  // namespace recald::assessment::spread_test
