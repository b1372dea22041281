/// The gap between model and meters on held-out months, and whether it shrank.
#pragma once

#include <span>
#include <vector>

#include "core/diagnosis/ground.hpp"
#include "core/diagnosis/held_scores.hpp"

namespace recald::diagnosis {

/// How well a model predicts one meter's months, as shares of the measured mean; NaN without data.
struct MeterGap {
  double nmbe_sim_minus_meas;  ///< Of the day parts' energy.
  double cvrmse_daily;
  double cvrmse_monthly;
  double log_score;          ///< Mean log density per month.
  double discrepancy_share;  ///< V: share of the structural terms in the residual, fitted months.
};

struct GapChange {
  std::vector<MeterGap> before;             ///< (m)
  std::vector<MeterGap> after;              ///< (m)
  std::vector<ScoreGain> log_score_change;  ///< (m) summed over the shown months.
  bool confirmed = false;                   ///< Every added effect is confirmed.
};

/// The judge of `ground` itself: its fitted months teach, its noise scores.
/// @param held  Months of `ground` to score.
[[nodiscard]] HeldJudge judge_of(const SiteProblem& site, const Ground& ground,
                                 const Observations& held);

/// @param ground  The model to judge.
/// @param judge   The first model's, for all models compared: a change of noise or scale does not
///                make a better model.
[[nodiscard]] std::vector<MeterGap> gaps_of(const SiteProblem& site, const Ground& ground,
                                            const HeldJudge& judge);

/// By more than two standard errors plus one nat.
[[nodiscard]] bool is_worse(const ScoreGain& meter);

/// (m) root mean square error of the parts of held-out months, kW; NaN without readings.
[[nodiscard]] Eigen::ArrayXd held_errors_kW(const SiteProblem& site,
                                            const Eigen::ArrayXXd& parts_kW);

/// Better by more than two standard errors, and at least three to one; and the errors of meters
/// whose scores get worse grow by no more than a quarter of what errors of others shrink by: an
/// effect that is certainly present may have a side effect on another meter that the model gets
/// wrong. Harm counts in kW, because in nats a precise meter outweighs all others.
/// @param change  Of the scores of months that chose nothing: the effect and the base parameters
///                fitted together, minus the base parameters fitted alone on the same ground. Two
///                models from separate searches would also differ in their modes.
/// @param error_change_kW  (m) held-out errors with the effect minus without.
[[nodiscard]] bool is_confirmed(const MonthScores& change, const Eigen::ArrayXd& error_change_kW);

/// @param changes  One per added effect.
[[nodiscard]] GapChange change_of(std::vector<MeterGap> before, std::vector<MeterGap> after,
                                  std::span<const MonthScores> changes);

}  // namespace recald::diagnosis
