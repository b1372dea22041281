/// Whether an effect found with the hourly model also improves a monthly model: fitted on the
/// months to fit and to choose by, judged on the held-out months.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/diagnosis/check/held_scores.hpp"
#include "core/model/model_kind.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

/// 90 % interval of a change, after - before, over resampled months; NaN without data.
struct ChangeInterval {
  double low;
  double high;
};

/// The gap of a model other than the hourly one, before and after adding the same effects, on the
/// same held-out months.
struct ModelGap {
  /// One output; NaN without data.
  struct Figures {
    double nmbe_sim_minus_meas;
    double cvrmse;  ///< Of months.
    double log_score;
    double discrepancy_share;
  };
  /// For one output, after - before.
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

/// The verdict of a monthly model on effects found with the hourly one.
struct MonthlyVote {
  /// Log scores are mean log densities of a month's daily average in kWh, with the errors of the
  /// fit before, because a change of noise does not make a better model. A monthly model has no
  /// discrepancy share of its own: NaN.
  ModelGap gap;
  ScoreGain total;  ///< Of all outputs, month by month.
  int months_shown;
  int figures_shown;  ///< Measured monthly figures in the held-out months, of all outputs.
  /// Whether there are data to judge by.
  [[nodiscard]] bool has_vote() const { return figures_shown > 0; }
  /// Whether the held-out months agree with the effect in this model too: the loss is at most one
  /// nat plus two standard errors. An effect that does not change monthly figures, such as a clock,
  /// must not fail because of their noise. @pre has_vote()
  [[nodiscard]] bool agrees() const { return total.sum >= -2.0 * total.se - 1.0; }
};

/// Measurements of a monthly model's outputs, and the use of each month.
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

/// Checks that there are enough data to fit and judge a model with this many parameters.
/// @return not_enough_data  fewer than two held-out months, or too few to fit.
[[nodiscard]] Result<void> require_enough(const MonthlyFigures& measured, std::size_t parameters);

/// Fits both models, maximum a posteriori by Gauss-Newton, the second with the errors of the first,
/// and compares them on the held-out months.
/// @param before, after  With all months of `measured` and the same parameters.
/// @note  Well under a second. Same input, same bytes.
[[nodiscard]] MonthlyVote monthly_vote(MonthlyModel& before, MonthlyModel& after,
                                       std::span<const Parameter> parameters,
                                       const MonthlyFigures& measured, std::uint64_t seed);

}  // namespace recald::diagnosis
