/// The method under test beside the simpler ones that it must beat.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/blind/scoring/gap_scores.hpp"
#include "tests/blind/scoring/intervals.hpp"
#include "tests/blind/scoring/scored_case.hpp"

namespace recald::blind {

enum class Comparison { beaten, not_shown, not_beaten };

[[nodiscard]] std::string_view comparison_name(Comparison comparison);

/// The main method minus this one, over the cases that both have.
struct PairedDifference {
  int cases = 0;
  int only_main_right = 0;
  int only_other_right = 0;
  std::optional<Score> right;  ///< Difference of the shares of right answers, bootstrapped.
  double mcnemar_p = 1.0;      ///< Exact, two-sided.
  std::optional<Score> gap;    ///< Median over cases of R (CV(RMSE)), main minus this.
  Comparison verdict = Comparison::not_shown;  ///< On right answers.
};

struct MethodRow {
  std::string method;
  int cases = 0;
  std::optional<Score> right;  ///< All blocks.
  std::optional<Score> single_right;
  std::optional<Score> single_top1;
  std::optional<Score> false_names;
  std::optional<Score> out_of_catalogue_wrong_name;
  std::optional<Score> gap;  ///< Median R (CV(RMSE)) over all cases with an effect.
  std::optional<Score> wall_s;
  std::optional<PairedDifference> against;  ///< Absent in the main method's own row.
};

/// Two-sided exact McNemar test: of the cases in which just one of two is right, is one of the two
/// ahead by more than a fair coin would have it? @see McNemar (1947), Psychometrika 12(2).
[[nodiscard]] double mcnemar_exact(int only_first, int only_second);

/// Beaten if ahead in right answers with p < 0.05, not beaten if not even ahead. The resampled
/// interval is for the eye: with few differing cases it is too narrow to decide on.
[[nodiscard]] PairedDifference paired_difference(const ScoredCases& main, const ScoredCases& other,
                                                 const OracleGaps& oracles);

/// One row a method in `results`, the main one first, the oracle left out.
[[nodiscard]] std::vector<MethodRow> compare_methods(const AnswerKey& key,
                                                     std::span<const CaseResult> results,
                                                     const std::string& main_method,
                                                     const EffectClasses& classes);

}  // namespace recald::blind
