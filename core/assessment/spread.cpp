#include "core/assessment/spread.hpp"

#include <algorithm>
#include <boost/math/distributions/inverse_gamma.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace recald::assessment {
namespace {

/// Log density of z where its variance is inverse gamma: Student's t.
double log_density(double z, const Spread::Variance& variance) {
  const double scale = std::sqrt(variance.mean);
  return std::log(boost::math::pdf(boost::math::students_t{variance.months}, z / scale) / scale);
}

boost::math::inverse_gamma_distribution<> distribution_of(const Spread::Variance& variance) {
  return boost::math::inverse_gamma_distribution<>{0.5 * variance.months,
                                                   0.5 * variance.months * variance.mean};
}

}  // namespace

double Spread::shape(double level) const {
  return prior_.least_share + std::clamp(level, 0.0, 2.0);
}

Spread::Variance Spread::variance_at(double level) const {
  double all = 0.0;
  double near = 0.0;
  double weights = 0.0;
  for (const Seen& month : seen_) {
    const double off = (month.level - level) / prior_.level_width;
    const double weight = std::exp(-0.5 * off * off);
    all += month.square;
    near += weight * month.square;
    weights += weight;
  }
  const double count = static_cast<double>(seen_.size());
  const double pooled = (prior_.months + all) / (prior_.months + count);
  const double months = prior_.months_at_level + weights;
  return {shape(level) * (prior_.months_at_level * pooled + near) / months, months};
}

Spread::Variance Spread::heavy(const Variance& variance) const {
  const double freedom = prior_.tail_freedom;
  return {variance.mean * (freedom - 2.0) / freedom, 1.0 / (1.0 / variance.months + 1.0 / freedom)};
}

double Spread::heavy_probability() const { return 1.0 / (1.0 + std::exp(-log_odds_)); }

Forecast Spread::adapt(const Forecast& forecast, double level) const {
  const Variance variance = variance_at(level);
  const auto plain = distribution_of(variance);
  const auto heavier = distribution_of(heavy(variance));
  const double normal_share = 1.0 - heavy_probability();
  const double centre = forecast.mean();
  const Eigen::Index n = forecast.means.size();
  const double least = 0.5 / static_cast<double>(n);
  Forecast adapted = forecast;
  // One of n spreads for each component, in an order that has nothing to do with theirs: steps of
  // the golden section. They are denser where they are large, and weigh less there: a mixture has
  // no heavier tail than its widest component.
  for (Eigen::Index i = 0; i < n; ++i) {
    const double step = 0.6180339887498949 * static_cast<double>(i);
    const double share = step - std::floor(step);
    const bool is_plain = share < normal_share;
    const double within =
        is_plain ? share / normal_share : (share - normal_share) / (1.0 - normal_share);
    const double above = 1.0 - std::clamp(within, least, 1.0 - least);
    const double scale = std::sqrt(
        boost::math::quantile(boost::math::complement(is_plain ? plain : heavier, above * above)));
    adapted.means(i) = centre + scale * (forecast.means(i) - centre);
    adapted.sds(i) = scale * forecast.sds(i);
    adapted.weights(i) *= 2.0 * above;
  }
  adapted.weights /= adapted.weights.sum();
  adapted.means.array() += centre - adapted.mean();
  return adapted;
}

void Spread::take(double level, double standardised) {
  const Variance expected = variance_at(level);
  const double most = prior_.surprise_max * std::sqrt(expected.mean);
  const double z = std::clamp(standardised, -most, most);
  log_odds_ += log_density(z, heavy(expected)) - log_density(z, expected);
  seen_.push_back({level, z * z / shape(level)});
}

}  // namespace recald::assessment
