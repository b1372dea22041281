/// How well months that were not fitted are predicted.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/diagnosis/joint_fit.hpp"
#include "core/diagnosis/usual_errors.hpp"

namespace recald::diagnosis {

/// Log density of each held month by its index, meter by meter (m): a Student t, since the size of
/// that month's noise is not known to the digit and months that go wrong altogether must not decide
/// by the square of it. No month knows its neighbours'
/// slow structure, or the answer would leak across the split.
using MonthScores = std::vector<std::map<int, double>>;

/// An error that the model makes in every week and weather is no evidence in a held month. Each
/// model therefore includes the recurring patterns and usual errors that it needs on the fitted
/// months; only the uncertainty that remains counts as noise.
struct HeldJudge {
  const SiteProblem& site;
  const Observations& fit;             ///< Months that teach the patterns.
  const NoiseNode& node;               ///< Their noise.
  const Observations& held;            ///< Months that are scored.
  std::span<const NoiseLevel> levels;  ///< (m) noise of a held month.

  /// @param usual  The usual errors that the model was fitted with.
  [[nodiscard]] MonthScores scores(const JointFit& model, const UsualErrors& usual) const;
};

/// A sum over months and its standard error, the months taken as independent.
struct ScoreGain {
  double sum = 0.0;
  double se = 0.0;  ///< 0 where there are fewer than two months.
};

/// with - without, month by month.
[[nodiscard]] MonthScores difference(const MonthScores& with, const MonthScores& without);
/// Of several differences of the same months.
[[nodiscard]] MonthScores sum_of(std::span<const MonthScores> changes);

/// Of each meter (m). @param change  A difference.
[[nodiscard]] std::vector<ScoreGain> gain_by_meter(const MonthScores& change);
/// Of all meters together, month by month.
[[nodiscard]] ScoreGain gain_over(const MonthScores& change);

}  // namespace recald::diagnosis
