/// How far a model is from the meters on months that chose nothing, and whether that shrank.
/// @see discrepancy.md, 3.4
#pragma once

#include <vector>

#include "core/diagnosis/ground.hpp"
#include "core/diagnosis/held_scores.hpp"

namespace recald::diagnosis {

/// How well a model tells one meter's months. Shares of the mean measured; NaN where none was.
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
  std::vector<ScoreGain> log_score_change;  ///< (m) after - before, summed over the shown months.
  /// Better by `kLeastConfirmation` in units of the effects' null scale, and no meter worse by two
  /// standard errors and a nat.
  bool confirmed = false;
};

/// Three to one: what months that chose nothing must say for an effect.
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

/// On the months that `before` keeps back, by its own judge.
/// @param null_scale  Of the effects that were added, the largest.
[[nodiscard]] GapChange change_of(const SiteProblem& site, const Ground& before,
                                  const Ground& after, double null_scale);

}  // namespace recald::diagnosis
