/// The targets that were fixed before any answer was opened, and whether the scores reach them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/blind/scoring/cost_scores.hpp"
#include "tests/blind/scoring/gap_scores.hpp"
#include "tests/blind/scoring/intervals.hpp"
#include "tests/blind/scoring/naming_scores.hpp"
#include "tests/blind/scoring/probability_scores.hpp"

namespace recald::blind {

enum class Verdict {
  met,            ///< The estimate reaches the target and the one-sided 95 % bound clears it.
  met_not_shown,  ///< The estimate reaches it; so few cases cannot show more.
  missed,
  no_cases,
  not_gated,  ///< Stands there to be read beside another; nothing was promised.
};

[[nodiscard]] std::string_view verdict_name(Verdict verdict);

/// What a score must reach. Bounds are included.
struct Goal {
  double min;
  double max;
};

/// `exact` scores (a largest run time) are met or missed; nothing is to be shown.
[[nodiscard]] Verdict verdict_of(const std::optional<Score>& score, const Goal& goal, bool exact);

struct Target {
  std::string world;  ///< Whose buildings it is about.
  std::string quantity;
  std::optional<Score> score;
  std::string minimum_text;    ///< "at least 75 %".
  std::string excellent_text;  ///< "-" where no more is aimed at.
  Verdict minimum = Verdict::no_cases;
  Verdict excellent = Verdict::no_cases;
  std::optional<int> decimals;  ///< Of a figure that is not a share; shares are in per cent.
};

/// Those of one world. @param world  As in the answers.
[[nodiscard]] std::vector<Target> targets(const std::string& world, const NamingScores& naming,
                                          const ProbabilityScores& probability,
                                          const GapScores& gap, const CostScores& cost);

}  // namespace recald::blind
