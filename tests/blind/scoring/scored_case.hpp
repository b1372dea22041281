/// An answer and what a method said about it, side by side.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "tests/blind/scoring/answers.hpp"
#include "tests/blind/scoring/case_result.hpp"

namespace recald::blind {

/// Effect id -> class.
using EffectClasses = std::map<std::string, std::string>;

/// Whether what was said is true. Everything else that is scored about names is counted from this.
struct Judgement {
  std::string truth;   ///< "night_setback_missing", "a + b", "none", "unknown (ev_charging)".
  std::string said;    ///< "night_setback_missing", "none", "unknown", "confusable".
  bool right = false;  ///< The outcome is the true one and the names are exactly the true ones.
  bool top1 = false;   ///< The first of the ranking is true (of a pair: one of the two).
  bool top3 = false;   ///< One of the first three is.
  bool class_right = false;    ///< The first of the ranking is of the class of a hidden effect.
  bool wrong_name = false;     ///< An effect was added that is not there.
  int hidden_named = 0;        ///< How many of the hidden effects were added.
  bool set_has_truth = false;  ///< Confusable, and a hidden effect is among the set.
};

struct ScoredCase {
  const Answer* answer;
  const CaseResult* result;
  Judgement judgement;
};

using ScoredCases = std::vector<ScoredCase>;

/// What a perfect method says first: the effects of the catalogue; "unknown" for effects out of
/// the catalogue; "none" where nothing is hidden (a decoy is nothing).
[[nodiscard]] std::vector<std::string> true_answers(const Answer& answer);

/// What the method said, best first: effects added, in order; then the rest by probability, "none"
/// and "unknown" among them. A method without probabilities ends with its outcome.
/// Equal probabilities: those that are not true come first, so that a tie earns nothing.
[[nodiscard]] std::vector<std::string> ranking(const CaseResult& result, const Answer& answer);

/// The set that a confusable outcome offers: as given, or the effects of probability >= 0.1.
[[nodiscard]] std::vector<std::string> confusable_set(const CaseResult& result);

[[nodiscard]] Judgement judge(const Answer& answer, const CaseResult& result,
                              const EffectClasses& classes);

/// Whether what is hidden moves a meter by 3 % or more: what claims about large effects count.
[[nodiscard]] bool is_large(const Answer& answer);

/// Joins results of one method with the answers. Cases without a result are left out.
[[nodiscard]] ScoredCases cases_of_method(const AnswerKey& key, std::span<const CaseResult> results,
                                          const std::string& method, const EffectClasses& classes);

/// @return not_found naming the first result whose case has no answer.
[[nodiscard]] Result<void> check_cases_known(const AnswerKey& key,
                                             std::span<const CaseResult> results);

/// Classes of all effects in the answers, joined with those of the list. @return invalid_value if
/// an effect has two classes.
[[nodiscard]] Result<EffectClasses> classes_of(const AnswerKey& key, EffectClasses listed);

}  // namespace recald::blind
