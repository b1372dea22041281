#include "core/regression/weather_response.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random/rng.hpp"

namespace recald::regression::weather_response_test {
namespace {

using Eigen::Index;

constexpr int kDaysAMonth = 30;

/// Months of thirty days; three terms as a temperature, its part above 18 °C, and sun.
ResponseDays made_days(int months, double offset_K, Rng& rng) {
  const int n = months * kDaysAMonth;
  ResponseDays days;
  days.terms.resize(n, 3);
  days.season.resize(n);
  double anomaly = 0.0;
  for (int i = 0; i < n; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / (12.0 * kDaysAMonth);
    anomaly = 0.8 * anomaly + 1.5 * rng.normal();
    const double temperature = 12.0 - 12.0 * std::cos(phase) + anomaly + offset_K;
    const double sun = 150.0 - 100.0 * std::cos(phase) + 40.0 * rng.normal();
    days.terms.row(i) << temperature, std::max(temperature - 18.0, 0.0), sun;
    days.season[i] = phase;
    days.kinds.push_back(i % 7 == 5 ? 1 : i % 7 == 6 ? 2 : 0);
    days.months.push_back(i / kDaysAMonth);
  }
  return days;
}

/// Cooling of two runs, the second twice as sensitive; less of it at weekends.
Eigen::MatrixXd made_cooling(const ResponseDays& days) {
  Eigen::MatrixXd values(2, days.count());
  for (Index i = 0; i < days.count(); ++i) {
    const double share = days.kinds[static_cast<std::size_t>(i)] == 0 ? 1.0 : 0.4;
    values(0, i) = share * (50.0 + 12.0 * days.terms(i, 1) + 0.1 * days.terms(i, 2));
    values(1, i) = share * (60.0 + 24.0 * days.terms(i, 1) + 0.2 * days.terms(i, 2));
  }
  return values;
}

Eigen::MatrixXd with_noise(Eigen::MatrixXd values, double sd, Rng& rng) {
  for (double& value : values.reshaped()) value += sd * rng.normal();
  return values;
}

/// (runs x months) means of thirty days.
Eigen::MatrixXd month_means(const Eigen::MatrixXd& values) {
  Eigen::MatrixXd means(values.rows(), values.cols() / kDaysAMonth);
  for (Index m = 0; m < means.cols(); ++m) {
    means.col(m) = values.middleCols(m * kDaysAMonth, kDaysAMonth).rowwise().mean();
  }
  return means;
}
Eigen::MatrixXd month_peaks(const Eigen::MatrixXd& values) {
  Eigen::MatrixXd peaks(values.rows(), values.cols() / kDaysAMonth);
  for (Index m = 0; m < peaks.cols(); ++m) {
    peaks.col(m) = values.middleCols(m * kDaysAMonth, kDaysAMonth).rowwise().maxCoeff();
  }
  return peaks;
}

TEST(WeatherResponse, FindsALawThatItCanExpress) {
  Rng rng{3};
  const ResponseDays seen = made_days(24, 0.0, rng);
  const ResponseDays warmer = made_days(12, 2.0, rng);
  const auto fit = fit_weather_response(seen, made_cooling(seen), {false});
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  const Eigen::MatrixXd truth = month_means(made_cooling(warmer));
  const Eigen::MatrixXd error = predict_months(*fit, warmer) - truth;
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.01 * truth.mean()) << error;
  EXPECT_LT(fit->errors.front().sd, 0.01 * truth.mean());
}

// The months that were left out speak for those that nobody has seen.
TEST(WeatherResponse, ToldErrorIsThatOfNewMonths) {
  double told = 0.0;
  double found = 0.0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Rng rng{seed};
    const ResponseDays seen = made_days(24, 0.0, rng);
    const ResponseDays next = made_days(12, 0.0, rng);
    const auto fit = fit_weather_response(seen, with_noise(made_cooling(seen), 20.0, rng), {false});
    ASSERT_TRUE(fit.has_value());
    const Eigen::MatrixXd truth = month_means(with_noise(made_cooling(next), 20.0, rng));
    told += std::pow(fit->errors.front().sd, 2);
    found += (predict_months(*fit, next) - truth).array().square().mean();
  }
  EXPECT_NEAR(std::sqrt(told / found), 1.0, 0.15);
}

// A fit that has seen a month would explain part of what is odd about it.
TEST(WeatherResponse, AnOddMonthIsNotPredictedByItself) {
  Rng rng{5};
  const ResponseDays seen = made_days(24, 0.0, rng);
  Eigen::MatrixXd values = made_cooling(seen);
  values.middleCols(7 * kDaysAMonth, kDaysAMonth).array() += 40.0;
  const auto fit = fit_weather_response(seen, values, {false});
  ASSERT_TRUE(fit.has_value());
  const Eigen::VectorXd& by_month = fit->errors.front().by_month;
  ASSERT_EQ(by_month.size(), 24);
  EXPECT_NEAR(by_month[7], 40.0, 4.0);
  EXPECT_LT(by_month[1], 10.0);
}

// Unexplained swings raise the highest of thirty days: 2.04 of their spread where days are alike.
TEST(WeatherResponse, PeaksCountTheSpreadOfDays) {
  Rng rng{7};
  const ResponseDays seen = made_days(48, 0.0, rng);
  const ResponseDays next = made_days(120, 0.0, rng);
  const double sd = 30.0;
  const auto fit = fit_weather_response(seen, with_noise(made_cooling(seen), sd, rng), {true});
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->errors.front().spread_share, 1.0);
  const Eigen::MatrixXd truth = month_peaks(with_noise(made_cooling(next), sd, rng));
  EXPECT_NEAR((predict_months(*fit, next) - truth).mean(), 0.0, 0.15 * sd);
}

TEST(WeatherResponse, EachOutputAndRunIsItsOwn) {
  Rng rng{9};
  const ResponseDays seen = made_days(24, 0.0, rng);
  const Eigen::MatrixXd cooling = made_cooling(seen);
  Eigen::MatrixXd both(2, 2 * seen.count());
  both << Eigen::MatrixXd::Constant(2, seen.count(), 7.0), cooling;
  const auto alone = fit_weather_response(seen, cooling, {false});
  const auto together = fit_weather_response(seen, both, {true, false});
  ASSERT_TRUE(alone.has_value() && together.has_value());
  const Eigen::MatrixXd predicted = predict_months(*together, seen);
  ASSERT_EQ(predicted.cols(), 48);
  EXPECT_TRUE(predicted.leftCols(24).isConstant(7.0, 1e-9));
  EXPECT_LT((predicted.rightCols(24) - predict_months(*alone, seen)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(WeatherResponse, FewMonthsAndValuesThatAreNoneAreRefused) {
  Rng rng{11};
  const ResponseDays two = made_days(2, 0.0, rng);
  EXPECT_EQ(fit_weather_response(two, made_cooling(two), {false}).error().code,
            ErrorCode::not_enough_data);
  const ResponseDays three = made_days(3, 0.0, rng);
  Eigen::MatrixXd values = made_cooling(three);
  values(1, 4) = std::nan("");
  EXPECT_EQ(fit_weather_response(three, values, {false}).error().code, ErrorCode::not_finite);
}

}  // namespace
}  // namespace recald::regression::weather_response_test
