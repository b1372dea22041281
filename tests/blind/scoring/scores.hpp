/// Everything that is said about one population.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "tests/blind/scoring/calibration_scores.hpp"
#include "tests/blind/scoring/comparison.hpp"
#include "tests/blind/scoring/cost_scores.hpp"
#include "tests/blind/scoring/drift_scores.hpp"
#include "tests/blind/scoring/gap_scores.hpp"
#include "tests/blind/scoring/naming_scores.hpp"
#include "tests/blind/scoring/probability_scores.hpp"
#include "tests/blind/scoring/targets.hpp"

namespace recald::blind {

/// A case whose answer was not right: the truth and what was said, in words.
struct Failure {
  std::string case_id;
  std::string block;
  std::string truth;
  std::string said;
};

/// What was said in one world.
struct WorldScores {
  std::string world;
  int cases = 0;
  NamingScores naming;
  ProbabilityScores probability;
  GapScores gap;
  CalibrationScores calibration;
  DriftScores drift;
  CostScores cost;
};

struct Scores {
  std::string method;
  int cases = 0;                        ///< Scored.
  int population_cases = 0;             ///< In the answers.
  std::map<std::string, int> versions;  ///< Version of the program -> cases.
  NamingScores naming;
  ProbabilityScores probability;
  GapScores gap;
  CostScores cost;
  std::vector<WorldScores> worlds;  ///< Side by side; the scores above are of all cases together.
  std::vector<Target> targets;
  std::vector<MethodRow> methods;
  std::vector<Failure> failures;
};

struct ScoringOptions {
  std::string method = "recald";  ///< The one under test.
  int reliability_bins = 5;       ///< Ten once a population has about a thousand cases.
};

/// @pre Every result's case has an answer.
[[nodiscard]] Scores compute_scores(const AnswerKey& key, std::span<const CaseResult> results,
                                    const EffectClasses& classes, const ScoringOptions& options);

/// A sentence for each method (the oracle excepted) that lacks cases. `method` is asked for even
/// if it has no result at all.
[[nodiscard]] std::vector<std::string> missing_cases(const AnswerKey& key,
                                                     std::span<const CaseResult> results,
                                                     const std::string& method);

}  // namespace recald::blind
