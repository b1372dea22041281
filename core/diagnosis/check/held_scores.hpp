/// How well held-out months are predicted.
#pragma once

#include <map>
#include <set>
#include <span>
#include <vector>

#include "core/diagnosis/check/usual_errors.hpp"
#include "core/diagnosis/evidence/joint_fit.hpp"

namespace recald::diagnosis {

/// Log density of each held-out month by its index, meter by meter (m). It is a Student t, because
/// the size of that month's noise is not known exactly and months that go wrong altogether must not
/// decide by their square. A month does not use its neighbours' slow structure, which would leak
/// across the split.
using MonthScores = std::vector<std::map<int, double>>;

/// An error that the model makes in every week and all weather is no evidence in a held-out month.
/// So each model includes the recurring patterns and usual errors that it needs on the fitted
/// months; only the remaining uncertainty counts as noise.
struct HeldJudge {
  const SiteProblem& site;
  const Observations& fit;             ///< Months from which patterns are learnt.
  const NoiseNode& node;               ///< Their noise.
  const Observations& held;            ///< Months that are scored.
  std::span<const NoiseLevel> levels;  ///< (m) noise of a held-out month.

  /// @param usual  The usual errors used in the model's fit.
  [[nodiscard]] MonthScores scores(const JointFit& model, const UsualErrors& usual) const;
};

/// A sum over months and its standard error, with months treated as independent.
struct ScoreGain {
  double sum = 0.0;
  double se = 0.0;  ///< 0 for fewer than two months.
};

/// `with` minus `without`, month by month.
[[nodiscard]] MonthScores difference(const MonthScores& with, const MonthScores& without);

/// Of each meter (m). @param change  A difference.
[[nodiscard]] std::vector<ScoreGain> gain_by_meter(const MonthScores& change);
/// Of all meters together, month by month.
[[nodiscard]] ScoreGain gain_over(const MonthScores& change);
/// The same if months of `apart` are expected to differ from the others, which then is no scatter:
/// each kind varies around its own mean. With fewer than three months apart, as above.
[[nodiscard]] ScoreGain gain_over(const MonthScores& change, const std::set<int>& apart);

}  // namespace recald::diagnosis
