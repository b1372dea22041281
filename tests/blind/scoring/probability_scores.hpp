/// Whether the stated probabilities can be believed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/blind/scoring/intervals.hpp"
#include "tests/blind/scoring/scored_case.hpp"

namespace recald::blind {

/// Cases whose most probable answer had a probability within [low, high); the last bin has its
/// upper end too.
struct ReliabilityBin {
  double low = 0.0;
  double high = 0.0;
  int cases = 0;
  double mean_probability = 0.0;
  std::optional<Score> right;
};

/// The same for one kind of most probable answer: a name, "none", "unknown".
struct ReliabilityOfKind {
  std::string kind;
  int cases = 0;
  double mean_probability = 0.0;
  std::optional<Score> right;
};

/// If an effect were named whenever it is the most probable answer and P >= threshold.
struct AbstentionPoint {
  double threshold = 0.0;
  std::optional<Score> coverage;     ///< Of the cases with an effect of the catalogue: named.
  std::optional<Score> accuracy;     ///< Of all that is named: right.
  std::optional<Score> false_names;  ///< Of the cases without an effect: named.
};

struct ProbabilityScores {
  int cases = 0;               ///< With probabilities; the others are not scored here.
  std::optional<Score> brier;  ///< Mean over cases of sum_k (p_k - y_k)^2, 0 to 2. Without pairs.
  std::optional<Score> log_loss;  ///< Mean of -ln P(truth), floored. Without pairs.
  int floored = 0;                ///< Cases whose truth had less than the floor.
  /// The s at which probabilities in proportion to p^s would have had the best log loss: 1 where
  /// they are as sure as they may be, below 1 where they are too sure. Without pairs.
  std::optional<Score> slope;
  std::vector<ReliabilityBin> bins;  ///< Equal widths over 0 … 1.
  std::optional<Score> ece;          ///< sum_b n_b/n |right_b - mean probability_b|.
  std::vector<ReliabilityOfKind> kinds;
  std::optional<Score> sure_names_right;  ///< Named with P >= 0.8: the name is right.
  std::vector<AbstentionPoint> abstention;
};

/// ln P below this is not rewarded further: -ln 1e-6 = 13.8.
inline constexpr double kProbabilityFloor = 1e-6;

/// The answer judged is the most probable one among names, none and unknown (of equal ones a
/// wrong one); of a pair either effect is right. Brier and log loss need one truth, so pairs are
/// left out there.
/// @see Brier (1950), Mon. Weather Rev. 78(1); Naeini, Cooper, Hauskrecht (2015), AAAI, for ECE.
/// @pre bins > 0
[[nodiscard]] ProbabilityScores probability_scores(const ScoredCases& cases, int bins);

}  // namespace recald::blind
