#include "core/assessment/level_forecast.hpp"

#include <boost/math/distributions/inverse_gamma.hpp>
#include <cassert>
#include <cmath>

namespace recald::assessment {
namespace {

/// Equally likely variances that stand for all of them.
constexpr int kVariances = 64;

}  // namespace

LevelForecast::LevelForecast(const Prior& prior)
    : kappa_((prior.scatter / prior.level_sd) * (prior.scatter / prior.level_sd)),
      shape_(0.5 * prior.scatter_months),
      rate_(shape_ * prior.scatter * prior.scatter) {}

Forecast LevelForecast::forecast(double modelled) const {
  assert(modelled > 0.0);
  return mixture(modelled, modelled);
}

Forecast LevelForecast::forecast_mean(const Eigen::VectorXd& modelled,
                                      const Eigen::VectorXd& weights) const {
  return mixture(weights.dot(modelled), weights.cwiseProduct(modelled).norm());
}

Forecast LevelForecast::mixture(double modelled, double scattering) const {
  const boost::math::inverse_gamma variance{shape(), rate()};
  Forecast forecast{Eigen::VectorXd::Constant(kVariances, modelled * (1.0 + level())),
                    Eigen::VectorXd(kVariances),
                    Eigen::VectorXd::Constant(kVariances, 1.0 / kVariances)};
  for (int k = 0; k < kVariances; ++k) {
    const double s2 = boost::math::quantile(variance, (k + 0.5) / kVariances);
    forecast.sds(k) =
        std::sqrt(s2 * (scattering * scattering + modelled * modelled / (kappa_ + months_)));
  }
  return forecast;
}

double LevelForecast::rate() const {
  return rate_ + 0.5 * (squares_ - (kappa_ + months_) * level() * level());
}

double LevelForecast::scatter() const { return std::sqrt(rate() / shape()); }

double LevelForecast::level_sd() const { return scatter() / std::sqrt(kappa_ + months_); }

void LevelForecast::take(double modelled, double measured) {
  assert(modelled > 0.0);
  const double difference = measured / modelled - 1.0;
  months_ += 1.0;
  sum_ += difference;
  squares_ += difference * difference;
}

}  // namespace recald::assessment
