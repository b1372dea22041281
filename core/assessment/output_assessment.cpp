#include "core/assessment/output_assessment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/absent.hpp"
#include "core/assessment/given_data.hpp"
#include "core/assessment/interval_score.hpp"

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

/// @param least  What the meter cannot go below.
MonthForecast summary_of(const Forecast& forecast, double least) {
  const auto at = [&](double probability) {
    return std::max(least, forecast.quantile(probability));
  };
  return {std::max(least, forecast.mean()), at(0.05), at(0.25), at(0.50), at(0.75), at(0.95)};
}

/// Zero for a meter that has never run backwards.
double least_of(std::span<const double> measured) {
  const bool has_run_backwards = std::ranges::any_of(measured, [](double v) { return v < 0.0; });
  return has_run_backwards ? -std::numeric_limits<double>::infinity() : 0.0;
}

/// The forecasts of the months of `measured` that are not absent.
ForecastFit fit_of(std::span<const double> measured, double least,
                   const std::vector<std::optional<Forecast>>& forecasts) {
  std::vector<double> compared(measured.begin(), measured.end());
  std::vector<double> expected(measured.size(), 0.0);
  ForecastScores scores{};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!forecasts[i]) compared[i] = kAbsent;
    if (std::isnan(compared[i])) continue;
    const MonthForecast month = summary_of(*forecasts[i], least);
    expected[i] = month.mean;
    scores.months += 1;
    scores.inside_50 += month.q25 <= measured[i] && measured[i] <= month.q75 ? 1 : 0;
    scores.inside_90 += month.q05 <= measured[i] && measured[i] <= month.q95 ? 1 : 0;
    scores.crps += surprise_of(*forecasts[i], measured[i]).crps;
    scores.interval_score_90 += interval_score({month.q05, month.q95}, 0.9, measured[i]);
  }
  if (scores.months == 0) return {};
  scores.crps /= scores.months;
  scores.interval_score_90 /= scores.months;
  return {metrics_or_nothing(compared, expected), scores};
}

/// @pre some validation month is measured
double mean_of_unseen(std::span<const double> validation, std::span<const double> month_days) {
  double sum = 0.0;
  double days = 0.0;
  for (std::size_t i = 0; i < validation.size(); ++i) {
    if (std::isnan(validation[i])) continue;
    const double share = month_days.empty() ? 1.0 : month_days[i];
    sum += share * validation[i];
    days += share;
  }
  return sum / days;
}

}  // namespace

ForecastAssessment assess_forecasts(std::span<const double> measured,
                                    std::span<const MonthRole> roles,
                                    const OutputForecasts& forecasts,
                                    std::span<const double> month_days) {
  const std::vector<double> calibration = of_role(measured, roles, MonthRole::calibration);
  const std::vector<double> validation = of_role(measured, roles, MonthRole::validation);
  const double least = least_of(calibration);
  ForecastAssessment forecast;
  for (const std::optional<Forecast>& month : forecasts.months) {
    forecast.months.push_back(month ? std::optional{summary_of(*month, least)} : std::nullopt);
  }
  forecast.calibration = fit_of(calibration, least, forecasts.months);
  forecast.blocks = fit_of(calibration, least, forecasts.blocks);
  forecast.validation = fit_of(validation, least, forecasts.months);
  if (forecasts.unseen_mean) {
    forecast.unseen_mean = UnseenMean{mean_of_unseen(validation, month_days),
                                      summary_of(*forecasts.unseen_mean, least)};
  }
  forecast.unreliable_months = forecasts.unreliable_months;
  return forecast;
}

OutputAssessment assess_output(std::span<const double> measured, std::span<const MonthRole> roles,
                               const Simulations& simulations, const OutputForecasts& forecasts,
                               std::span<const double> month_days) {
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
  result.simulated.assign(simulations.posterior_mean.begin(), simulations.posterior_mean.end());
  for (Eigen::Index i = 0; i < simulations.draws.cols(); ++i) {
    const auto column = simulations.draws.col(i);
    result.boxes.push_back(box_plot({column.data(), static_cast<std::size_t>(column.size())}));
  }
  result.draw_cvrmse_calibration = draw_cvrmses(calibration, simulations.draws);
  result.draw_cvrmse_validation = draw_cvrmses(validation, simulations.draws);
  result.forecast = assess_forecasts(measured, roles, forecasts, month_days);
  return result;
}

}  // namespace recald::assessment
