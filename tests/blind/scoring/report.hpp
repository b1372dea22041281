/// The two forms in which scores leave: for programs and for people.
#pragma once

#include <string>
#include <vector>

#include "tests/blind/scoring/scores.hpp"

namespace recald::blind {

/// How the scores came about.
struct Circumstances {
  std::vector<std::string>
      warnings;            ///< Sentences that belong on top: partial, opened before, torn.
  std::string whole_hash;  ///< Of the seal.
  std::string results_hash;
  std::string scorer_version;
};

/// scores.json. Same input, same bytes: no clock. A score is {value, cases, hits?, interval95?,
/// lower95?, upper95?} or null without cases.
[[nodiscard]] std::string scores_json(const Scores& scores, const Circumstances& circumstances);

/// scores.md, a page of tables: what was asked, what came out, and every failure by case.
[[nodiscard]] std::string scores_markdown(const Scores& scores, const Circumstances& circumstances);

/// scores.html, the same as figures: rates with their intervals in each world, and how often what
/// was said with a probability is true. It loads nothing.
[[nodiscard]] std::string scores_html(const Scores& scores, const Circumstances& circumstances);

}  // namespace recald::blind
