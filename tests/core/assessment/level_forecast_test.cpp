#include "core/assessment/level_forecast.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <vector>

#include "core/drift/watch/calibration_check.hpp"
#include "core/random/rng.hpp"

namespace recald::assessment::level_forecast_test {
namespace {

// Before any month: Student's t with six degrees of freedom, wider by what is not known of the
// level.
TEST(LevelForecast, BeginsAsItsPrior) {
  const Forecast forecast = LevelForecast{}.forecast(1000.0);
  const boost::math::students_t t{6.0};
  const double scale = 1000.0 * std::sqrt(0.04 * 0.04 + 0.03 * 0.03);
  for (const double p : {0.05, 0.25, 0.5, 0.9}) {
    EXPECT_NEAR(forecast.quantile(p), 1000.0 + scale * boost::math::quantile(t, p), 0.5) << p;
  }
}

// The same by hand: kappa 1 + n, the mean of the differences shrunk, the variance with both sums.
TEST(LevelForecast, LearnsAsConjugatePriorsDo) {
  LevelForecast level{{.level_sd = 0.05, .scatter = 0.05, .scatter_months = 4.0}};
  const std::vector<double> differences{0.10, 0.06, 0.08, 0.12};
  for (const double one : differences) level.take(200.0, 200.0 * (1.0 + one));
  const double mean = 0.36 / 5.0;
  const double shape = 2.0 + 2.0;
  // About the sample mean 0.09, and for its distance from 0.
  const double rate = 2.0 * 0.0025 + 0.5 * (0.0001 + 0.0009 + 0.0001 + 0.0009) +
                      0.5 * 4.0 * 1.0 * 0.09 * 0.09 / 5.0;
  const boost::math::students_t t{2.0 * shape};
  const double scale = std::sqrt(rate / shape * 1.2);
  const Forecast forecast = level.forecast(100.0);
  for (const double p : {0.05, 0.5, 0.9}) {
    EXPECT_NEAR(forecast.quantile(p), 100.0 * (1.0 + mean + scale * boost::math::quantile(t, p)),
                0.05)
        << p;
  }
}

// Where levels and scatters come from the prior, its forecasts are true.
TEST(LevelForecast, IsCalibrated) {
  Rng rng{3, 0};
  std::vector<double> surprises;
  for (int world = 0; world < 300; ++world) {
    // chi-squared of six is a sum of squares; the variance its inverse.
    double chi2 = 0.0;
    for (int i = 0; i < 6; ++i) chi2 += std::pow(rng.normal(), 2);
    const double s = std::sqrt(6.0 * 0.04 * 0.04 / chi2);
    const double level = rng.normal() * s * 0.03 / 0.04;
    LevelForecast forecasts;
    for (int month = 0; month < 12; ++month) {
      const double measured = 50.0 * (1.0 + level + s * rng.normal());
      surprises.push_back(surprise_of(forecasts.forecast(50.0), measured).standardised);
      forecasts.take(50.0, measured);
    }
  }
  const auto check = drift::check_calibration(surprises);
  ASSERT_TRUE(check.has_value());
  EXPECT_GT(check->pvalue, 0.001) << check->mean << " " << check->sd << " " << check->lag_one;
}

}  // namespace
}  // namespace recald::assessment::level_forecast_test
