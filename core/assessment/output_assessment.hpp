/// One output of a calibrated model held against its meter, before and after.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/assessment/fit_metrics.hpp"
#include "core/assessment/predictive.hpp"
#include "core/random/rng.hpp"

namespace recald::assessment {

/// What a month is there for. Unused months are shown, never counted.
enum class MonthRole { calibration, validation, unused };

struct PeriodMetrics {
  std::optional<FitMetrics> calibration;  ///< Absent where fewer than two months are measured.
  std::optional<FitMetrics> validation;
};

/// How well predictive intervals (parameters, discrepancy and error) held what was measured.
struct PredictiveScores {
  int inside_50;  ///< Months within the central 50 % interval.
  int inside_90;
  int months;
  double crps;  ///< Mean over the months, in the output's unit.
};

struct OutputAssessment {
  PeriodMetrics before;  ///< At the prior modes: the uncalibrated model.
  PeriodMetrics prior_mean;
  PeriodMetrics after;         ///< At the posterior mean, one simulation, as the seed does.
  std::vector<BoxPlot> boxes;  ///< (months) of the simulated draws: parameters alone.
  std::vector<double> draw_cvrmse_calibration;  ///< One a draw.
  std::vector<double> draw_cvrmse_validation;
  std::optional<PredictiveScores> scores_calibration;
  std::optional<PredictiveScores> scores_validation;
};

/// Simulations of one output at points and draws. All in the output's unit, (months) each.
struct Simulations {
  std::span<const double> prior_mode;
  std::span<const double> prior_mean;
  std::span<const double> posterior_mean;
  Eigen::MatrixXd draws;       ///< (draws x months)
  Eigen::MatrixXd predictive;  ///< (draws x months) the same with discrepancy and error added.
};

/// @param measured  (months) NaN: not measured or not usable.
[[nodiscard]] OutputAssessment assess_output(std::span<const double> measured,
                                             std::span<const MonthRole> roles,
                                             const Simulations& simulations);

/// Adds one draw of discrepancy and error to each simulated value, independent from month to month:
/// the discrepancy is not extrapolated, only its size is.
/// @param draws            (draws x months) output's unit.
/// @param spread_sd        (draws) sd of discrepancy and error together, output's unit.
/// @param extra_variances  (months) known, unit squared; or empty.
[[nodiscard]] Eigen::MatrixXd add_discrepancy_and_error(const Eigen::MatrixXd& draws,
                                                        const Eigen::VectorXd& spread_sd,
                                                        std::span<const double> extra_variances,
                                                        Rng& rng);

}  // namespace recald::assessment
