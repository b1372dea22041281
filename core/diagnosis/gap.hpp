/// The gap between model and meters on held-out months, and whether it shrank.
#pragma once

#include <span>
#include <vector>

#include "core/diagnosis/ground.hpp"
#include "core/diagnosis/held_scores.hpp"

namespace recald::diagnosis {

/// How well a model predicts one meter's months, as shares of the measured mean; NaN if there is
/// none.
struct MeterGap {
  double nmbe_sim_minus_meas;  ///< Of the day parts' energy.
  double cvrmse_daily;
  double cvrmse_monthly;
  double log_score;          ///< Mean log density a month.
  double discrepancy_share;  ///< V: what the structure takes of what is left, fitted months.
};

struct GapChange {
  std::vector<MeterGap> before;             ///< (m)
  std::vector<MeterGap> after;              ///< (m)
  std::vector<ScoreGain> log_score_change;  ///< (m) summed over the shown months.
  bool confirmed = false;                   ///< Every effect that was added is.
};

/// Three to one: the support that an effect needs from held-out months.
inline constexpr double kLeastConfirmation = 1.1;

/// The judge of `ground` itself: what it was fitted to teaches, its noise scores.
/// @param held  Months to be scored, of `ground`.
[[nodiscard]] HeldJudge judge_of(const SiteProblem& site, const Ground& ground,
                                 const Observations& held);

/// @param ground  The model to be judged.
/// @param judge   Of the first model, for all that are compared: a change of noise or of scale
///                is no better model.
[[nodiscard]] std::vector<MeterGap> gaps_of(const SiteProblem& site, const Ground& ground,
                                            const HeldJudge& judge);

/// By more than two standard errors and a nat.
[[nodiscard]] bool is_worse(const ScoreGain& meter);

/// Better by `kLeastConfirmation` in units of the effect's null scale, and meters that are worse
/// lose less than a quarter of what the others gain: an effect that is certainly present may have a
/// side effect on another meter that the model gets wrong.
/// @param change  Of the scores of months that chose nothing: the effect and the base parameters
///                fitted together, over the base parameters fitted alone on the same ground. Two
/// models that were searched for separately would also differ by their modes.
[[nodiscard]] bool is_confirmed(const MonthScores& change, double null_scale);

/// @param changes  One for each effect that was added.
[[nodiscard]] GapChange change_of(std::vector<MeterGap> before, std::vector<MeterGap> after,
                                  std::span<const MonthScores> changes);

}  // namespace recald::diagnosis
