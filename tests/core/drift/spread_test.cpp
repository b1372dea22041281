#include "core/drift/spread.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/drift/calibration_check.hpp"
#include "core/random/rng.hpp"

namespace recald::drift {
namespace {

Forecast standard_normal(Eigen::Index components) {
  return {Eigen::VectorXd::Zero(components), Eigen::VectorXd::Ones(components),
          Eigen::VectorXd::Constant(components, 1.0 / static_cast<double>(components))};
}

// Nothing known yet: as wide as forecast, with six months' doubt about that.
TEST(Spread, BeginsAsStudentsT) {
  const Forecast adapted = Spread{}.adapt(standard_normal(256), 0.5);
  const boost::math::students_t t{6.0};
  for (const double p : {0.05, 0.25, 0.5, 0.9}) {
    EXPECT_NEAR(adapted.quantile(p), boost::math::quantile(t, p), 0.02) << p;
  }
}

// By hand: 12 surprises of 2 at the same level. All months: (6 + 48) / 18 = 3; there
// (6 * 3 + 48) / 18 = 11 / 3, known as well as by 18 months.
TEST(Spread, LearnsFromMonthsAtTheSameLevel) {
  Spread spread;
  for (int i = 0; i < 12; ++i) spread.take(0.3, i % 2 == 0 ? 2.0 : -2.0);
  EXPECT_NEAR(spread.variance_at(0.3).mean, 11.0 / 3.0, 1e-12);
  EXPECT_NEAR(spread.variance_at(0.3).months, 18.0, 1e-12);
  // Far away only what all months say is known.
  EXPECT_NEAR(spread.variance_at(5.0).mean, 3.0, 1e-12);
  EXPECT_NEAR(spread.variance_at(5.0).months, 6.0, 1e-12);
}

TEST(Spread, KeepsTheMeanAndTheShape) {
  Spread spread;
  for (int i = 0; i < 200; ++i) spread.take(0.5, 2.0);
  Forecast two = standard_normal(200);
  two.means.head(100).setConstant(3.0);
  two.means.tail(100).setConstant(5.0);
  const Forecast adapted = spread.adapt(two, 0.5);
  EXPECT_NEAR(adapted.mean(), 4.0, 0.02);
  EXPECT_NEAR(adapted.sd() / two.sd(), 2.0, 0.05);
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
// those adapted to what was learnt are.
TEST(Spread, MakesForecastsTrueWhereErrorsDependOnTheLevel) {
  Rng rng{5, 0};
  const Forecast forecast = standard_normal(128);
  std::vector<double> plain, adapted;
  for (int world = 0; world < 40; ++world) {
    Spread spread;
    for (int month = 0; month < 60; ++month) {
      const double level = 0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * month / 12.0);
      const double measured = (level < 0.5 ? 2.5 : 0.3) * rng.normal();
      const double before = surprise_of(forecast, measured).standardised;
      if (month >= 24) {
        plain.push_back(before);
        adapted.push_back(surprise_of(spread.adapt(forecast, level), measured).standardised);
      }
      spread.take(level, before);
    }
  }
  EXPECT_LT(check_calibration(plain)->pvalue, 1e-6);
  const auto check = check_calibration(adapted);
  EXPECT_NEAR(check->sd, 1.0, 0.1);
}

}  // namespace
}  // namespace recald::drift
