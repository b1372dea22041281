/// What naming was good for: the gap closed on held months, harm to other meters, parameters freed
/// from bias, the effect's interval.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/blind/scoring/intervals.hpp"
#include "tests/blind/scoring/scored_case.hpp"

namespace recald::blind {

/// The method whose lines give the refit with the true effect.
inline constexpr std::string_view kOracle = "oracle";

/// R = (E_before - E_after) / (E_before - E_oracle): 0 nothing closed, 1 as well as with the truth.
/// Empty where a fit is absent or the oracle itself closes nothing.
struct GapReduction {
  std::optional<double> cvrmse;     ///< E: CV(RMSE) of the most affected meter.
  std::optional<double> log_score;  ///< E: minus the log score summed over meters.
};

/// Refits with the true effect, by case.
using OracleGaps = std::map<std::string, Gap>;

/// The gaps of the lines of method "oracle"; a line of another method may carry its own oracle.
[[nodiscard]] OracleGaps oracle_gaps(std::span<const CaseResult> results);

/// Where nothing was added and no gap is given, nothing changed: R = 0, if the oracle's line says
/// that there was a gap to close.
[[nodiscard]] GapReduction gap_reduction(const ScoredCase& scored, const OracleGaps& oracles);

struct BiasScores {
  std::optional<Score> before;  ///< Median over cases of the mean |E[theta] - theta*| / prior sd.
  std::optional<Score> after;
  std::optional<Score> ratio;  ///< Median over cases of after / before.
};

struct GapScores {
  int large_named = 0;          ///< Cases with large effects of the catalogue, one added.
  std::optional<Score> cvrmse;  ///< Median R over those whose R is known.
  std::optional<Score> log_score;
  std::optional<Score> cvrmse_all;  ///< The same over all cases with an effect, named or not.
  std::optional<Score> log_score_all;
  std::optional<Score> harm;  ///< Of the cases with an addition: another meter worse by > 2 se.
  int additions_without_harm_figures = 0;
  BiasScores bias;  ///< Of the cases with an effect of the catalogue and an addition.
  std::optional<Score> effect_coverage;  ///< Effect named right: its 90 % interval has the truth.
  int other_units = 0;                   ///< Left out there: the interval is in another unit.
  std::vector<std::string> parameters_without_truth;  ///< In results, not in answers.
};

[[nodiscard]] GapScores gap_scores(const ScoredCases& cases, const OracleGaps& oracles);

/// Mean over shared parameters of |mean - truth| / prior sd; empty if none is shared.
[[nodiscard]] std::optional<double> mean_bias(const Answer& answer,
                                              const std::map<std::string, Posterior>& posteriors);

}  // namespace recald::blind
