#include "core/assessment/output_assessment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/absent.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::assessment {
namespace {

/// The measured months of one role; the others become absent.
std::vector<double> of_role(std::span<const double> measured, std::span<const MonthRole> roles,
                            MonthRole role) {
  std::vector<double> kept(measured.begin(), measured.end());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (roles[i] != role) kept[i] = kAbsent;
  }
  return kept;
}

std::optional<FitMetrics> metrics_or_nothing(std::span<const double> measured,
                                             std::span<const double> simulated) {
  const auto metrics = fit_metrics(measured, simulated);
  return metrics ? std::optional{*metrics} : std::nullopt;
}

std::vector<double> draw_cvrmses(std::span<const double> measured, const Eigen::MatrixXd& draws) {
  std::vector<double> result;
  Eigen::VectorXd simulated(draws.cols());
  for (Eigen::Index d = 0; d < draws.rows(); ++d) {
    simulated = draws.row(d).transpose();
    const auto metrics =
        fit_metrics(measured, {simulated.data(), static_cast<std::size_t>(simulated.size())});
    if (metrics) result.push_back(metrics->cvrmse);
  }
  return result;
}

std::optional<PredictiveScores> score(std::span<const double> measured,
                                      const Eigen::MatrixXd& predictive) {
  PredictiveScores scores{};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!std::isfinite(measured[i])) continue;
    const auto column = predictive.col(static_cast<Eigen::Index>(i));
    std::vector<double> sorted(column.begin(), column.end());
    std::ranges::sort(sorted);
    const auto inside = [&](double share) {
      return quantile_of_sorted(sorted, 0.5 - 0.5 * share) <= measured[i] &&
             measured[i] <= quantile_of_sorted(sorted, 0.5 + 0.5 * share);
    };
    scores.inside_50 += inside(0.5) ? 1 : 0;
    scores.inside_90 += inside(0.9) ? 1 : 0;
    scores.months += 1;
    scores.crps += crps(sorted, measured[i]);
  }
  if (scores.months == 0) return {};
  scores.crps /= scores.months;
  return scores;
}

}  // namespace

OutputAssessment assess_output(std::span<const double> measured, std::span<const MonthRole> roles,
                               const Simulations& simulations) {
  assert(measured.size() == roles.size());
  const std::vector<double> calibration = of_role(measured, roles, MonthRole::calibration);
  const std::vector<double> validation = of_role(measured, roles, MonthRole::validation);
  const auto periods = [&](std::span<const double> simulated) {
    return PeriodMetrics{metrics_or_nothing(calibration, simulated),
                         metrics_or_nothing(validation, simulated)};
  };
  OutputAssessment result;
  result.before = periods(simulations.prior_mode);
  result.prior_mean = periods(simulations.prior_mean);
  result.after = periods(simulations.posterior_mean);
  for (Eigen::Index i = 0; i < simulations.draws.cols(); ++i) {
    const auto column = simulations.draws.col(i);
    result.boxes.push_back(box_plot({column.data(), static_cast<std::size_t>(column.size())}));
  }
  result.draw_cvrmse_calibration = draw_cvrmses(calibration, simulations.draws);
  result.draw_cvrmse_validation = draw_cvrmses(validation, simulations.draws);
  result.scores_calibration = score(calibration, simulations.predictive);
  result.scores_validation = score(validation, simulations.predictive);
  return result;
}

Eigen::MatrixXd add_discrepancy_and_error(const Eigen::MatrixXd& draws,
                                          const Eigen::VectorXd& spread_sd,
                                          std::span<const double> extra_variances, Rng& rng) {
  assert(spread_sd.size() == draws.rows());
  Eigen::MatrixXd predictive = draws;
  for (Eigen::Index d = 0; d < draws.rows(); ++d) {
    for (Eigen::Index i = 0; i < draws.cols(); ++i) {
      const double extra =
          extra_variances.empty() ? 0.0 : extra_variances[static_cast<std::size_t>(i)];
      predictive(d, i) += std::sqrt(spread_sd[d] * spread_sd[d] + extra) * rng.normal();
    }
  }
  return predictive;
}

}  // namespace recald::assessment
