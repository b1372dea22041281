#include "tests/blind/scoring/cost_scores.hpp"

#include <algorithm>
#include <vector>

namespace recald::blind {
namespace {

std::optional<Spread> spread_of(const ScoredCases& cases,
                                std::optional<double> CaseResult::*figure) {
  std::vector<double> values;
  for (const ScoredCase& scored : cases) {
    if (const auto& value = scored.result->*figure) values.push_back(*value);
  }
  if (values.empty()) return std::nullopt;
  return Spread{.median = median_score(values),
                .p95 = quantile_of(values, 0.95),
                .max = *std::ranges::max_element(values)};
}

}  // namespace

CostScores cost_scores(const ScoredCases& cases) {
  return {.wall_s = spread_of(cases, &CaseResult::wall_s),
          .peak_rss_MB = spread_of(cases, &CaseResult::peak_rss_MB)};
}

}  // namespace recald::blind
