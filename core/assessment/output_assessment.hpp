/// One output of a calibrated model held against its meter, before and after.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/assessment/box_plot.hpp"
#include "core/assessment/fit_metrics.hpp"

namespace recald::assessment {

/// What a month is there for. Unused months are shown, never counted.
enum class MonthRole { calibration, validation, unused };
[[nodiscard]] constexpr std::string_view name_of(MonthRole role) {
  constexpr std::array<std::string_view, 3> kNames{"calibration", "validation", "unused"};
  return kNames[static_cast<std::size_t>(role)];
}

struct PeriodMetrics {
  std::optional<FitMetrics> calibration;  ///< Absent where fewer than two months are measured.
  std::optional<FitMetrics> validation;
};

/// How well forecasts held what was measured.
struct ForecastScores {
  int months;
  int inside_50;  ///< Months within the central 50 % interval.
  int inside_90;
  double crps;               ///< Mean over the months, in the output's unit.
  double interval_score_90;  ///< Of the 90 % interval, likewise.
};

/// Forecasts of some months held against the meter.
struct ForecastFit {
  std::optional<FitMetrics> metrics;  ///< Of the forecasts' means.
  std::optional<ForecastScores> scores;
};

struct MonthForecast {
  double mean;
  double q05;
  double q25;
  double q50;
  double q75;
  double q95;
};

/// The mean over the unseen months that were measured: what a year will use.
struct UnseenMean {
  double measured;
  MonthForecast forecast;
};

/// What the meter was expected to show by model, discrepancy and errors, given the data.
struct ForecastAssessment {
  std::vector<std::optional<MonthForecast>> months;  ///< (months)
  ForecastFit calibration;  ///< Each month from the others, never in sample.
  ForecastFit blocks;       ///< The same months, three left out together.
  ForecastFit validation;   ///< From the calibration months alone, the whole period ahead.
  std::optional<UnseenMean> unseen_mean;
  int unreliable_months = 0;  ///< Calibration months whose importance weights say little.
};

struct OutputAssessment {
  PeriodMetrics before;  ///< At the prior modes: the uncalibrated model.
  PeriodMetrics prior_mean;
  PeriodMetrics after;            ///< At the posterior mean, one simulation, as the seed does.
  std::vector<double> simulated;  ///< (months) That simulation.
  std::vector<BoxPlot> boxes;     ///< (months) of the simulated draws: parameters alone.
  std::vector<double> draw_cvrmse_calibration;  ///< One a draw.
  std::vector<double> draw_cvrmse_validation;
  ForecastAssessment forecast;
  double model_weight = 1.0;  ///< Of the model in the forecast; the rest is the yardstick's.
  /// The forecast by the model alone; absent where there is no yardstick, so that `forecast` is it.
  std::optional<ForecastAssessment> by_model;
  /// The same by a regression of the meter's days on temperature alone.
  std::optional<ForecastAssessment> yardstick;
};

/// Simulations of one output at points and draws. All in the output's unit, (months) each.
struct Simulations {
  std::span<const double> prior_mode;
  std::span<const double> prior_mean;
  std::span<const double> posterior_mean;
  Eigen::MatrixXd draws;  ///< (draws x months)
};

struct OutputForecasts;

/// Forecasts held against the meter. @param measured, month_days  As below.
[[nodiscard]] ForecastAssessment assess_forecasts(std::span<const double> measured,
                                                  std::span<const MonthRole> roles,
                                                  const OutputForecasts& forecasts,
                                                  std::span<const double> month_days);

/// @param measured    (months) NaN: not measured or not usable.
/// @param month_days  (months) Empty: all months count alike.
[[nodiscard]] OutputAssessment assess_output(std::span<const double> measured,
                                             std::span<const MonthRole> roles,
                                             const Simulations& simulations,
                                             const OutputForecasts& forecasts,
                                             std::span<const double> month_days);

}  // namespace recald::assessment
