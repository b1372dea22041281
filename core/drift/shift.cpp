#include "core/drift/shift.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace recald::drift {
namespace {

double variance_of(const Eigen::VectorXd& draws) {
  return (draws.array() - draws.mean()).square().sum() / static_cast<double>(draws.size() - 1);
}

std::vector<double> sorted(const Eigen::VectorXd& draws) {
  std::vector<double> values{draws.begin(), draws.end()};
  std::ranges::sort(values);
  return values;
}

/// How far the mean of draws scatters from sample to sample of months, for a normal posterior. So
/// many draws have an error of their own, and know what was learnt to an error only: where that is
/// little it must not pass for nothing.
double scatter_of_mean(double variance, double prior_variance, Eigen::Index draws) {
  const auto count = static_cast<double>(draws);
  const double left = variance / prior_variance;
  const double learnt = std::max(0.0, 1.0 - left) + left * std::sqrt(2.0 / (count - 1.0));
  return variance * learnt + variance / count;
}

/// The area between two empirical distribution functions.
double area_between(const std::vector<double>& a, const std::vector<double>& b) {
  const double step_a = 1.0 / static_cast<double>(a.size());
  const double step_b = 1.0 / static_cast<double>(b.size());
  double area = 0.0;
  double height = 0.0;
  double last = std::min(a.front(), b.front());
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    const bool takes_a = j == b.size() || (i < a.size() && a[i] <= b[j]);
    const double here = takes_a ? a[i] : b[j];
    area += std::abs(height) * (here - last);
    last = here;
    height += takes_a ? step_a : -step_b;
    (takes_a ? i : j) += 1;
  }
  return area;
}

/// P(b > a), halves for equals.
double share_above(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (const double value : b) {
    const auto [first, last] = std::ranges::equal_range(a, value);
    sum += 0.5 * static_cast<double>((first - a.begin()) + (last - a.begin()));
  }
  return sum / (static_cast<double>(a.size()) * static_cast<double>(b.size()));
}

}  // namespace

Shift shift_between(const Eigen::VectorXd& then, const Eigen::VectorXd& now,
                    double prior_variance) {
  assert(then.size() >= 2 && now.size() >= 2);
  const double variance_then = variance_of(then);
  const double variance_now = variance_of(now);
  const double both = variance_then + variance_now;
  assert(both > 0.0);
  const double difference = now.mean() - then.mean();
  const double overlap = std::sqrt(2.0 * std::sqrt(variance_then * variance_now) / both) *
                         std::exp(-0.25 * difference * difference / both);
  const double scatter = scatter_of_mean(variance_then, prior_variance, then.size()) +
                         scatter_of_mean(variance_now, prior_variance, now.size());
  const auto before = sorted(then);
  const auto after = sorted(now);
  return {.standardised = difference / std::sqrt(both),
          .hellinger = std::sqrt(std::max(0.0, 1.0 - overlap)),
          .wasserstein = area_between(before, after),
          .increased = share_above(before, after),
          .pvalue = std::erfc(std::abs(difference) / std::sqrt(2.0 * scatter))};
}

}  // namespace recald::drift
