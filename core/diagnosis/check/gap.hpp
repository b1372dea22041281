/// The gap between model and meters on held-out months, and whether it shrank.
#pragma once

#include <set>
#include <span>
#include <vector>

#include "core/diagnosis/check/ground.hpp"
#include "core/diagnosis/check/held_scores.hpp"

namespace recald::diagnosis {

/// How well a model predicts one meter's months, as shares of the measured mean; NaN without data.
struct MeterGap {
  double nmbe_sim_minus_meas;  ///< Of the day parts' energy.
  double cvrmse_daily;
  double cvrmse_monthly;
  double log_score;          ///< Mean log density per month.
  double discrepancy_share;  ///< V: share of the structural terms in the residual, fitted months.
};

/// What additions do to the predictions of held-out months. The base parameters are fitted with and
/// without them on the same ground: two models from separate searches would also differ in their
/// modes.
struct HeldChange {
  MonthScores log_scores;  ///< With minus without.
  /// Log of the root mean square error of a month's parts, without minus with; 0.7: errors are half
  /// as large. Unlike a log score it needs no noise model: what the noise was learnt from still
  /// contains the effect, so the noise forgives much of it.
  MonthScores error_cuts;
};

struct GapChange {
  std::vector<MeterGap> before;             ///< (m)
  std::vector<MeterGap> after;              ///< (m)
  std::vector<ScoreGain> log_score_change;  ///< (m) summed over the shown months.
  std::vector<ScoreGain> error_cut;         ///< (m) as `HeldChange::error_cuts`, summed likewise.
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
[[nodiscard]] bool is_worse(const ScoreGain& scores);

/// @param with_kW, without_kW  (parts x m) of two models.
/// @return `HeldChange::error_cuts`. Squares are taken over at least a tenth of the meter's mean
///         square, so that a month in which both models are nearly right does not decide.
[[nodiscard]] MonthScores error_cuts(const SiteProblem& site, const Eigen::ArrayXXd& with_kW,
                                     const Eigen::ArrayXXd& without_kW);

/// Months in which an effect does at least a hundredth of what it does in its strongest one.
/// @param with_kW, without_kW  (parts x m) with the same base parameters.
[[nodiscard]] std::set<int> months_moved(const SiteProblem& site, const Eigen::ArrayXXd& with_kW,
                                         const Eigen::ArrayXXd& without_kW);

/// By more than two standard errors.
[[nodiscard]] bool grows_errors(const ScoreGain& error_cut);

/// (m) root mean square error of the parts of held-out months, kW; NaN without readings.
[[nodiscard]] Eigen::ArrayXd held_errors_kW(const SiteProblem& site,
                                            const Eigen::ArrayXXd& parts_kW);

/// Errors of at least two months shrink by more than two standard errors, months before an effect
/// begins and after it taken apart. Errors of meters that surely grow do so by no more than a
/// quarter of what errors of others shrink by: an effect that is certainly present may have a side
/// effect on another meter that the model gets wrong. Harm counts in kW, because as a ratio a
/// precise meter outweighs all others.
/// @param error_cuts  Of months that chose nothing.
/// @param moved       As `months_moved`.
/// @param error_change_kW  (m) held-out errors with the effect minus without.
[[nodiscard]] bool is_confirmed(const MonthScores& error_cuts, const std::set<int>& moved,
                                const Eigen::ArrayXd& error_change_kW);

/// @param changes  One per addition.
[[nodiscard]] GapChange change_of(std::vector<MeterGap> before, std::vector<MeterGap> after,
                                  std::span<const HeldChange> changes);

}  // namespace recald::diagnosis
