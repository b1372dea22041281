#include "tests/blind/scoring/scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace recald::blind {
namespace {

std::string probability_text(const CaseResult& result, const std::string& name) {
  const auto found = result.probabilities.find(name);
  return found == result.probabilities.end() ? "" : fmt::format(" (P {:.2f})", found->second);
}

std::string said_text(const ScoredCase& scored) {
  const CaseResult& result = *scored.result;
  const std::string outcome{outcome_name(result.outcome)};
  if (result.outcome == Outcome::named) {
    std::vector<std::string> names;
    for (const std::string& name : result.named) {
      names.push_back(name + probability_text(result, name));
    }
    return fmt::format("{}", fmt::join(names, ", then "));
  }
  if (result.outcome != Outcome::confusable) return outcome + probability_text(result, outcome);
  const bool true_one = scored.judgement.set_has_truth;
  return fmt::format("one of {}{}", fmt::join(confusable_set(result), ", "),
                     true_one ? " (the true one is among them)" : "");
}

std::string effect_text(const HiddenEffect& effect) {
  std::string text = effect.effect + fmt::format(", {:g} {}", effect.strength, effect.unit);
  if (effect.from) text += " from " + *effect.from;
  if (effect.to) text += " to " + *effect.to;
  for (const auto& [meter, share] : effect.share_of_meter) {
    text += fmt::format(", {:+.1f} % of {}", 100.0 * share, meter);
  }
  return text;
}

std::string truth_in_full(const Answer& answer) {
  std::vector<std::string> effects;
  for (const HiddenEffect& effect : answer.effects) effects.push_back(effect_text(effect));
  std::string text = effects.empty() ? "none" : fmt::format("{}", fmt::join(effects, "; "));
  if (!answer.decoys.empty()) text += fmt::format("; decoy {}", fmt::join(answer.decoys, ", "));
  if (answer.effects.empty()) return text;
  return text + fmt::format(" (moves {:.1f} %)", 100.0 * largest_share(answer));
}

std::vector<Failure> failures_of(const ScoredCases& cases) {
  std::vector<Failure> failures;
  for (const ScoredCase& scored : cases) {
    if (scored.judgement.right) continue;
    failures.push_back({.case_id = scored.answer->case_id,
                        .block = std::string(block_name(scored.answer->block)),
                        .truth = truth_in_full(*scored.answer),
                        .said = said_text(scored)});
  }
  return failures;
}

/// Worlds side by side: a result in one alone is half a result.
void score_worlds(const ScoredCases& cases, std::span<const CaseResult> results,
                  const ScoringOptions& options, Scores& scores) {
  const OracleGaps oracles = oracle_gaps(results);
  const Calibrations calibrations = calibrations_of(results);
  const Drifts drifts = drifts_of(results);
  std::map<std::string, ScoredCases> worlds;
  for (const ScoredCase& scored : cases) worlds[scored.answer->world].push_back(scored);
  for (const auto& [world, of] : worlds) {
    const WorldScores& one = scores.worlds.emplace_back(WorldScores{
        world, static_cast<int>(of.size()), naming_scores(of),
        probability_scores(of, options.reliability_bins), gap_scores(of, oracles),
        calibration_scores(of, calibrations), drift_scores(of, drifts), cost_scores(of)});
    for (Target& each : targets(world, one.naming, one.probability, one.gap, one.cost)) {
      scores.targets.push_back(std::move(each));
    }
  }
}

}  // namespace

Scores compute_scores(const AnswerKey& key, std::span<const CaseResult> results,
                      const EffectClasses& classes, const ScoringOptions& options) {
  const ScoredCases cases = cases_of_method(key, results, options.method, classes);
  Scores scores{.method = options.method,
                .cases = static_cast<int>(cases.size()),
                .population_cases = static_cast<int>(key.size())};
  for (const ScoredCase& scored : cases) ++scores.versions[scored.result->version];
  scores.naming = naming_scores(cases);
  scores.probability = probability_scores(cases, options.reliability_bins);
  scores.gap = gap_scores(cases, oracle_gaps(results));
  scores.cost = cost_scores(cases);
  score_worlds(cases, results, options, scores);
  scores.methods = compare_methods(key, results, options.method, classes);
  scores.failures = failures_of(cases);
  return scores;
}

std::vector<std::string> missing_cases(const AnswerKey& key, std::span<const CaseResult> results,
                                       const std::string& method) {
  std::map<std::string, std::set<std::string>> done;
  done[method];
  for (const CaseResult& result : results) {
    if (competes(result.method)) done[result.method].insert(result.case_id);
  }
  std::vector<std::string> sentences;
  for (const auto& [name, cases] : done) {
    std::vector<std::string> missing;
    for (const auto& [case_id, answer] : key) {
      if (!cases.contains(case_id)) missing.push_back(case_id);
    }
    if (missing.empty()) continue;
    constexpr std::size_t shown = 5;
    const std::size_t count = missing.size();
    missing.resize(std::min(count, shown));
    sentences.push_back(fmt::format("method {}: {} of {} cases have no result ({}{})", name, count,
                                    key.size(), fmt::join(missing, ", "),
                                    count > shown ? ", ..." : ""));
  }
  return sentences;
}

}  // namespace recald::blind
