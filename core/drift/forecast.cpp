#include "core/drift/forecast.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cassert>
#include <cmath>
#include <numbers>

namespace recald::drift {
namespace {

/// Beyond some 8 sd a double's probability is 0 or 1 and its normal score infinite.
constexpr double kTail = 1e-15;
constexpr double kReach_sd = 8.0;
constexpr int kGridPoints = 400;

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

}  // namespace

double Forecast::mean() const { return weights.dot(means); }

double Forecast::sd() const {
  const double centre = mean();
  const double variance =
      (weights.array() * ((means.array() - centre).square() + sds.array().square())).sum();
  return std::sqrt(variance);
}

double Forecast::cdf(double value) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < means.size(); ++i) {
    sum += weights[i] * normal_cdf((value - means[i]) / sds[i]);
  }
  return sum;
}

double Forecast::quantile(double probability) const {
  assert(probability > 0.0 && probability < 1.0);
  double low = (means - 40.0 * sds).minCoeff();
  double high = (means + 40.0 * sds).maxCoeff();
  const double close = 1e-9 * sd();
  while (high - low > close) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;  // no double is left between them
    (cdf(middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Surprise surprise_of(const Forecast& forecast, double measured) {
  assert(forecast.means.size() > 0);
  Surprise surprise{};
  surprise.pit = std::clamp(forecast.cdf(measured), kTail, 1.0 - kTail);
  surprise.standardised = boost::math::quantile(boost::math::normal{}, surprise.pit);

  const Eigen::ArrayXd z = (measured - forecast.means.array()) / forecast.sds.array();
  const Eigen::ArrayXd logs = forecast.weights.array().max(1e-300).log() - 0.5 * z.square() -
                              forecast.sds.array().log() - 0.5 * std::log(2.0 * std::numbers::pi);
  const double largest = logs.maxCoeff();
  surprise.log_score = largest + std::log((logs - largest).exp().sum());

  // The integral of (F(x) - 1{x >= y})^2 by the midpoint rule on either side of the jump.
  const double low = std::min(measured, (forecast.means - kReach_sd * forecast.sds).minCoeff());
  const double high = std::max(measured, (forecast.means + kReach_sd * forecast.sds).maxCoeff());
  const auto integral = [&](double from, double to, double step_height) {
    const double width = (to - from) / kGridPoints;
    double sum = 0.0;
    for (int i = 0; i < kGridPoints && width > 0.0; ++i) {
      const double off = forecast.cdf(from + (i + 0.5) * width) - step_height;
      sum += off * off * width;
    }
    return sum;
  };
  surprise.crps = integral(low, measured, 0.0) + integral(measured, high, 1.0);
  return surprise;
}

}  // namespace recald::drift
