/// Whether an effect that the hourly model was given also helps a monthly model: fitted on the
/// months to fit and to choose by, judged on the held-out months.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/diagnosis/held_scores.hpp"
#include "core/model/model_kind.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

/// 90 % interval of a change, after - before, over resampled months; NaN without a month.
struct ChangeInterval {
  double low;
  double high;
};

/// The gap of another model than the hourly one, before and after it got the same effects, on the
/// same held-out months.
struct ModelGap {
  /// One output; NaN where there is nothing to judge by.
  struct Figures {
    double nmbe_sim_minus_meas;
    double cvrmse;  ///< Of months.
    double log_score;
    double discrepancy_share;
  };
  /// Of one output, after - before.
  struct Change {
    ScoreGain log_score;
    ChangeInterval nmbe_size;
    ChangeInterval cvrmse;
  };
  ModelKind model = ModelKind::epc;
  std::vector<std::string> outputs;  ///< (n) as in calibration.json: "steam_daily_kWh"
  std::vector<Figures> before;       ///< (n)
  std::vector<Figures> after;        ///< (n)
  std::vector<Change> change;        ///< (n)
};

/// What a monthly model says of effects that the hourly one was given.
struct MonthlyVote {
  /// Log scores are mean log densities of a month's daily average in kWh, under the errors that the
  /// fit before left: a change of noise is no better model. A monthly model has no discrepancy
  /// share of its own: NaN.
  ModelGap gap;
  ScoreGain total;  ///< Of all outputs, month by month.
  int months_shown;
  int figures_shown;  ///< Measured monthly figures in them, of all outputs.
  /// Whether there is anything to judge by.
  [[nodiscard]] bool has_vote() const { return figures_shown > 0; }
  /// The held-out months do not contradict the effect in this model either: not by more than a nat
  /// beyond two standard errors. What leaves monthly figures as they are, a clock, must not fall
  /// for their noise. @pre has_vote()
  [[nodiscard]] bool agrees() const { return total.sum >= -2.0 * total.se - 1.0; }
};

/// What was measured of a monthly model's outputs, and which months may be used for what.
struct MonthlyFigures {
  std::vector<std::string> outputs;         ///< (n) as in calibration.json
  std::vector<std::vector<double>> values;  ///< (n) of (months); NaN: not measured.
  std::vector<std::size_t> fitted;          ///< Months to fit on.
  std::vector<std::size_t> shown;           ///< Held-out months.

  [[nodiscard]] double value(std::size_t output, std::size_t month) const {
    return values[output][month];
  }
  [[nodiscard]] bool has(std::size_t output, std::size_t month) const {
    return std::isfinite(value(output, month));
  }
};

/// Whether there is enough to fit a model of so many parameters and to judge it by.
/// @return not_enough_data  fewer than two months shown, or too few to fit.
[[nodiscard]] Result<void> require_enough(const MonthlyFigures& measured, std::size_t parameters);

/// Fits both models, maximum a posteriori by Gauss-Newton, the second under the errors that the
/// first one left, and compares them on the months shown.
/// @param before, after  Of all months of `measured` and the same parameters.
/// @note  Well under a second. Same input, same bytes.
[[nodiscard]] MonthlyVote monthly_vote(MonthlyModel& before, MonthlyModel& after,
                                       std::span<const Parameter> parameters,
                                       const MonthlyFigures& measured, std::uint64_t seed);

}  // namespace recald::diagnosis
