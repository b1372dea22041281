#include "core/savings/estimate.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>

#include "core/statistics/quantile.hpp"

namespace recald::savings {

Estimate estimate_of(const Eigen::VectorXd& draws) {
  Eigen::VectorXd sorted = draws;
  std::ranges::sort(sorted);
  return {.mean = draws.mean(),
          .q05 = quantile_of_sorted(sorted, 0.05),
          .q50 = quantile_of_sorted(sorted, 0.5),
          .q95 = quantile_of_sorted(sorted, 0.95),
          .probability_of_saving = (draws.array() > 0.0).cast<double>().mean()};
}

Estimate scaled(const Estimate& estimate, double factor) {
  return {factor * estimate.mean, factor * estimate.q05, factor * estimate.q50,
          factor * estimate.q95, estimate.probability_of_saving};
}

Estimate normal_estimate(double mean, double sd) {
  const boost::math::normal normal{mean, sd};
  return {.mean = mean,
          .q05 = boost::math::quantile(normal, 0.05),
          .q50 = mean,
          .q95 = boost::math::quantile(normal, 0.95),
          .probability_of_saving = boost::math::cdf(boost::math::complement(normal, 0.0))};
}

Payback simple_payback(double cost, const Estimate& money_a_year) {
  const auto years = [cost](double money) {
    return money > 0.0 ? std::optional{cost / money} : std::nullopt;
  };
  return {years(money_a_year.q95), years(money_a_year.q50), years(money_a_year.q05)};
}

}  // namespace recald::savings
