#include "core/drift/spread.hpp"

#include <algorithm>
#include <boost/math/distributions/inverse_gamma.hpp>
#include <cmath>

namespace recald::drift {

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
  const double months = prior_.months + weights;
  return {(prior_.months * pooled + near) / months, months};
}

Forecast Spread::adapt(const Forecast& forecast, double level) const {
  const Variance variance = variance_at(level);
  const boost::math::inverse_gamma distribution{0.5 * variance.months,
                                                0.5 * variance.months * variance.mean};
  const double centre = forecast.mean();
  const Eigen::Index n = forecast.means.size();
  Forecast adapted = forecast;
  // One of n equally likely spreads for each component, in an order that has nothing to do with
  // theirs: steps of the golden section.
  for (Eigen::Index i = 0; i < n; ++i) {
    const double step = 0.6180339887498949 * static_cast<double>(i);
    const double share = std::clamp(step - std::floor(step), 0.5 / static_cast<double>(n),
                                    1.0 - 0.5 / static_cast<double>(n));
    const double scale = std::sqrt(boost::math::quantile(distribution, share));
    adapted.means(i) = centre + scale * (forecast.means(i) - centre);
    adapted.sds(i) = scale * forecast.sds(i);
  }
  return adapted;
}

void Spread::take(double level, double standardised) {
  const double z = std::clamp(standardised, -prior_.surprise_max, prior_.surprise_max);
  seen_.push_back({level, z * z});
}

}  // namespace recald::drift
