#include "core/calibration/checks/psis.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "core/calibration/samplers/log_sum.hpp"

namespace recald::calibration {
namespace {

struct GeneralisedPareto {
  double shape;  // k
  double scale;  // sigma

  [[nodiscard]] double quantile(double p) const {
    return scale * std::expm1(-shape * std::log1p(-p)) / shape;
  }
};

/// Zhang and Stephens (2009), Technometrics 51(3): the posterior mean of theta = -k / sigma over a
/// grid of quantiles of a prior, then k in closed form. k is shrunk towards 0.5 as if by ten more
/// points (Vehtari et al. 2024, appendix C).
/// @param excess  Positive, ascending.
GeneralisedPareto fit_tail(const Eigen::ArrayXd& excess) {
  const Eigen::Index n = excess.size();
  const auto count = static_cast<double>(n);
  const auto grid = 30 + static_cast<Eigen::Index>(std::sqrt(count));
  const double quartile = excess(static_cast<Eigen::Index>(std::floor(count / 4.0 + 0.5)) - 1);
  const auto shape_at = [&](double theta) { return (-theta * excess).log1p().mean(); };
  Eigen::ArrayXd theta(grid);
  Eigen::ArrayXd log_likelihood(grid);
  for (Eigen::Index j = 0; j < grid; ++j) {
    const double position = static_cast<double>(grid) / (static_cast<double>(j) + 0.5);
    theta(j) = 1.0 / excess(n - 1) + (1.0 - std::sqrt(position)) / (3.0 * quartile);
    const double k = shape_at(theta(j));
    log_likelihood(j) = count * (std::log(-theta(j) / k) - k - 1.0);
  }
  const Eigen::ArrayXd weights = (log_likelihood - log_sum(log_likelihood)).exp();
  const double mean_theta = (theta * weights).sum();
  const double k = shape_at(mean_theta);
  return {.shape = (k * count + 5.0) / (count + 10.0), .scale = -k / mean_theta};
}

/// Indices of the `length` largest values, ascending by value.
std::vector<Eigen::Index> largest(const Eigen::VectorXd& values, Eigen::Index length) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::stable_sort(order, {}, [&](Eigen::Index i) { return values(i); });
  return {order.end() - length, order.end()};
}

}  // namespace

SmoothedWeights pareto_smooth(const Eigen::VectorXd& log_ratio, double relative_efficiency) {
  assert(log_ratio.size() >= 1 && log_ratio.allFinite() && relative_efficiency > 0.0);
  constexpr Eigen::Index tail_min = 5;
  const auto draws = static_cast<double>(log_ratio.size());
  const double length = std::min(0.2 * draws, 3.0 * std::sqrt(draws / relative_efficiency));
  const auto tail = static_cast<Eigen::Index>(std::ceil(length));
  SmoothedWeights result{log_ratio.array() - log_ratio.maxCoeff(),
                         std::numeric_limits<double>::infinity()};
  Eigen::VectorXd& log_weight = result.log_weight;
  if (tail >= tail_min) {
    // One index more: the tail begins at the largest value below it.
    const std::vector<Eigen::Index> places = largest(log_weight, tail + 1);
    const double cutoff = std::exp(log_weight(places.front()));
    Eigen::ArrayXd excess(tail);
    for (Eigen::Index i = 0; i < tail; ++i) {
      excess(i) = std::exp(log_weight(places[static_cast<std::size_t>(i + 1)])) - cutoff;
    }
    const double spread = log_weight(places.back()) - log_weight(places[1]);
    if (spread >= 10.0 * std::numeric_limits<double>::epsilon()) {
      const GeneralisedPareto pareto = fit_tail(excess);
      result.pareto_k = std::isnan(pareto.shape) ? result.pareto_k : pareto.shape;
      for (Eigen::Index i = 0; i < tail && std::isfinite(pareto.shape); ++i) {
        const double p = (static_cast<double>(i) + 0.5) / static_cast<double>(tail);
        const double smoothed = std::log(pareto.quantile(p) + cutoff);
        log_weight(places[static_cast<std::size_t>(i + 1)]) = std::min(smoothed, 0.0);
      }
    }
  }
  log_weight.array() -= log_sum(log_weight);
  return result;
}

Result<LeaveOneOut> psis_loo(const Eigen::MatrixXd& log_likelihood, double relative_efficiency) {
  const Eigen::Index units = log_likelihood.cols();
  if (units < 1 || log_likelihood.rows() < 5) {
    return failure(ErrorCode::not_enough_data,
                   "leave-one-out needs at least one unit and five draws, not " +
                       std::to_string(units) + " and " + std::to_string(log_likelihood.rows()));
  }
  LeaveOneOut result{.unit_elpd = Eigen::VectorXd(units), .pareto_k = Eigen::VectorXd(units)};
  const double log_draws = std::log(static_cast<double>(log_likelihood.rows()));
  double log_density_with_all = 0.0;
  for (Eigen::Index unit = 0; unit < units; ++unit) {
    const Eigen::VectorXd column = log_likelihood.col(unit);
    if (!column.allFinite()) {
      return failure(ErrorCode::not_finite, "the log likelihood of unit " +
                                                std::to_string(unit + 1) + " of " +
                                                std::to_string(units) + " is not finite in a draw");
    }
    // The ratio of the density without the unit to that with it is one over the unit's likelihood.
    const SmoothedWeights weights = pareto_smooth(-column, relative_efficiency);
    result.unit_elpd(unit) = log_sum(weights.log_weight + column);
    result.pareto_k(unit) = weights.pareto_k;
    log_density_with_all += log_sum(column) - log_draws;
  }
  result.elpd = result.unit_elpd.sum();
  const double mean = result.unit_elpd.mean();
  // A single unit has no spread, so its error is NaN, as in loo.
  const double variance =
      (result.unit_elpd.array() - mean).square().sum() / static_cast<double>(units - 1);
  result.standard_error = std::sqrt(static_cast<double>(units) * variance);
  result.effective_parameters = log_density_with_all - result.elpd;
  return result;
}

}  // namespace recald::calibration
