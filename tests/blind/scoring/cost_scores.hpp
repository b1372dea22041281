/// Time and memory of a case.
#pragma once

#include <optional>

#include "tests/blind/scoring/intervals.hpp"
#include "tests/blind/scoring/scored_case.hpp"

namespace recald::blind {

struct Spread {
  std::optional<Score> median;
  double p95 = 0.0;
  double max = 0.0;
};

/// Absent where no result gives the figure.
struct CostScores {
  std::optional<Spread> wall_s;
  std::optional<Spread> peak_rss_MB;
};

[[nodiscard]] CostScores cost_scores(const ScoredCases& cases);

}  // namespace recald::blind
