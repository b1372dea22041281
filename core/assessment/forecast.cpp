#include "core/assessment/forecast.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace recald::assessment {
namespace {

/// Beyond some 8 sd a double's probability is 0 or 1 and its normal score infinite.
constexpr double kTail = 1e-15;

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double pit_of(const Forecast& forecast, double measured) {
  return std::clamp(forecast.cdf(measured), kTail, 1.0 - kTail);
}

double normal_score(double pit) { return boost::math::quantile(boost::math::normal{}, pit); }

/// E|X| of X ~ N(mean, sd^2).
double mean_distance(double mean, double sd) {
  const double z = mean / sd;
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  return 2.0 * sd * density + mean * (2.0 * normal_cdf(z) - 1.0);
}

/// Continuous ranked probability score, E|X - y| - E|X - X'| / 2, of a mixture of normals.
/// @see Grimit, Gneiting, Berrocal, Johnson (2006), Q. J. R. Meteorol. Soc. 132, eq. (5).
double crps_of(const Forecast& forecast, double measured) {
  double score = 0.0;
  for (Eigen::Index i = 0; i < forecast.means.size(); ++i) {
    score += forecast.weights[i] * mean_distance(measured - forecast.means[i], forecast.sds[i]);
    double among =
        0.5 * forecast.weights[i] * mean_distance(0.0, std::numbers::sqrt2 * forecast.sds[i]);
    for (Eigen::Index j = 0; j < i; ++j) {
      among += forecast.weights[j] * mean_distance(forecast.means[i] - forecast.means[j],
                                                   std::hypot(forecast.sds[i], forecast.sds[j]));
    }
    score -= forecast.weights[i] * among;
  }
  return score;
}

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
  const double low = (means - 40.0 * sds).minCoeff();
  const double high = (means + 40.0 * sds).maxCoeff();
  const double close = 1e-9 * sd();
  std::uintmax_t evaluations = 200;  // bisection alone would end by then
  const auto [below, above] = boost::math::tools::toms748_solve(
      [&](double value) { return cdf(value) - probability; }, low, high, -probability,
      1.0 - probability, [&](double a, double b) { return std::abs(b - a) <= close; }, evaluations);
  return 0.5 * (below + above);
}

double log_density(const Forecast& forecast, double measured) {
  const Eigen::ArrayXd z = (measured - forecast.means.array()) / forecast.sds.array();
  const Eigen::ArrayXd logs = forecast.weights.array().max(1e-300).log() - 0.5 * z.square() -
                              forecast.sds.array().log() - 0.5 * std::log(2.0 * std::numbers::pi);
  const double largest = logs.maxCoeff();
  return largest + std::log((logs - largest).exp().sum());
}

double standardised_surprise(const Forecast& forecast, double measured) {
  return normal_score(pit_of(forecast, measured));
}

Surprise surprise_of(const Forecast& forecast, double measured) {
  assert(forecast.means.size() > 0);
  Surprise surprise{};
  surprise.pit = pit_of(forecast, measured);
  surprise.standardised = normal_score(surprise.pit);

  surprise.log_score = log_density(forecast, measured);
  surprise.crps = crps_of(forecast, measured);
  return surprise;
}

}  // namespace recald::assessment
