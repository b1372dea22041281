#include "tests/blind/scoring/comparison.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <map>
#include <set>

#include "tests/blind/scoring/calibration_scores.hpp"
#include "tests/blind/scoring/cost_scores.hpp"
#include "tests/blind/scoring/naming_scores.hpp"

namespace recald::blind {
namespace {

// In the order of the enumeration.
constexpr std::array<std::string_view, 3> kComparisons{"beaten", "not shown at this size",
                                                       "not beaten"};

Comparison verdict_on(const PairedDifference& difference) {
  if (difference.only_main_right <= difference.only_other_right) return Comparison::not_beaten;
  constexpr double level = 0.05;
  return difference.mcnemar_p < level ? Comparison::beaten : Comparison::not_shown;
}

MethodRow method_row(const ScoredCases& cases, const std::string& method,
                     const OracleGaps& oracles) {
  const NamingScores naming = naming_scores(cases);
  MethodRow row{.method = method,
                .cases = static_cast<int>(cases.size()),
                .right = naming.right,
                .false_names = naming.false_names,
                .out_of_catalogue_wrong_name = naming.out_of_catalogue_wrong_name,
                .gap = gap_scores(cases, oracles).cvrmse_all};
  for (const GroupScores& group : naming.groups) {
    if (group.group != kAllSingles) continue;
    row.single_right = group.right;
    row.single_top1 = group.top1;
  }
  if (const auto wall = cost_scores(cases).wall_s) row.wall_s = wall->median;
  return row;
}

}  // namespace

std::string_view comparison_name(Comparison comparison) {
  return kComparisons[static_cast<std::size_t>(comparison)];
}

double mcnemar_exact(int only_first, int only_second) {
  const int discordant = only_first + only_second;
  if (discordant == 0) return 1.0;
  const boost::math::binomial coin(discordant, 0.5);
  return std::min(1.0, 2.0 * boost::math::cdf(coin, std::min(only_first, only_second)));
}

PairedDifference paired_difference(const ScoredCases& main, const ScoredCases& other,
                                   const OracleGaps& oracles) {
  std::map<std::string, const ScoredCase*> other_by_case;
  for (const ScoredCase& scored : other) other_by_case[scored.answer->case_id] = &scored;

  PairedDifference difference;
  std::vector<double> right;
  std::vector<double> gap;
  for (const ScoredCase& scored : main) {
    const auto found = other_by_case.find(scored.answer->case_id);
    if (found == other_by_case.end()) continue;
    const ScoredCase& peer = *found->second;
    difference.only_main_right += scored.judgement.right && !peer.judgement.right;
    difference.only_other_right += !scored.judgement.right && peer.judgement.right;
    right.push_back(static_cast<double>(scored.judgement.right) -
                    static_cast<double>(peer.judgement.right));
    const auto ours = gap_reduction(scored, oracles).cvrmse;
    const auto theirs = gap_reduction(peer, oracles).cvrmse;
    if (ours && theirs) gap.push_back(*ours - *theirs);
  }
  difference.cases = static_cast<int>(right.size());
  difference.right = mean_score(std::move(right));
  difference.mcnemar_p = mcnemar_exact(difference.only_main_right, difference.only_other_right);
  difference.gap = median_score(std::move(gap));
  difference.verdict = verdict_on(difference);
  return difference;
}

std::vector<MethodRow> compare_methods(const AnswerKey& key, std::span<const CaseResult> results,
                                       const std::string& main_method,
                                       const EffectClasses& classes) {
  const OracleGaps oracles = oracle_gaps(results);
  std::set<std::string> others;
  for (const CaseResult& result : results) {
    if (result.method != main_method && competes(result.method)) others.insert(result.method);
  }
  const ScoredCases main = cases_of_method(key, results, main_method, classes);
  std::vector<MethodRow> rows{method_row(main, main_method, oracles)};
  for (const std::string& method : others) {
    const ScoredCases cases = cases_of_method(key, results, method, classes);
    rows.push_back(method_row(cases, method, oracles));
    rows.back().against = paired_difference(main, cases, oracles);
  }
  return rows;
}

}  // namespace recald::blind
