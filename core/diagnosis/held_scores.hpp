/// How well months that were not fitted are foretold.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/diagnosis/observations.hpp"

namespace recald::diagnosis {

/// Log density of each held month by its index, meter by meter (m). Marginal: no month knows its
/// neighbours' residuals, or the answer would leak across the split.
using MonthScores = std::vector<std::map<int, double>>;

/// @param levels    (m) noise that judges.
/// @param parts_kW  (parts x m) of the model.
[[nodiscard]] MonthScores held_scores(const SiteProblem& site, const Observations& held,
                                      std::span<const NoiseLevel> levels,
                                      const Eigen::ArrayXXd& parts_kW);

/// A sum over months and its standard error, the months taken as independent.
struct ScoreGain {
  double sum = 0.0;
  double se = 0.0;  ///< 0 where there are fewer than two months.
};

/// @return of each meter (m): with - without.
[[nodiscard]] std::vector<ScoreGain> gain_by_meter(const MonthScores& with,
                                                   const MonthScores& without);
/// Of all meters together, month by month.
[[nodiscard]] ScoreGain gain_over(const MonthScores& with, const MonthScores& without);

}  // namespace recald::diagnosis
