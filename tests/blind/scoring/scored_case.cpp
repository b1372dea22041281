#include "tests/blind/scoring/scored_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace recald::blind {
namespace {

constexpr double kLarge = 0.03;
constexpr double kSetMemberMin = 0.1;

bool contains(std::span<const std::string> list, std::string_view name) {
  return std::ranges::find(list, name) != list.end();
}

bool is_effect(std::string_view name) { return name != kNone && name != kUnknown; }

std::string truth_text(const Answer& answer) {
  if (answer.effects.empty()) return std::string(kNone);
  std::vector<std::string> effects;
  for (const HiddenEffect& effect : answer.effects) effects.push_back(effect.effect);
  std::ranges::sort(effects);
  const std::string joined = fmt::format("{}", fmt::join(effects, " + "));
  return answer.block == Block::out_of_catalogue ? fmt::format("{} ({})", kUnknown, joined)
                                                 : joined;
}

std::string said_text(const CaseResult& result) {
  if (result.outcome != Outcome::named) return std::string(outcome_name(result.outcome));
  std::vector<std::string> names = result.named;
  std::ranges::sort(names);
  return fmt::format("{}", fmt::join(names, " + "));
}

bool is_right(const Answer& answer, const CaseResult& result) {
  const std::vector<std::string> truth = true_answers(answer);
  if (result.outcome == Outcome::named) {
    return std::set(truth.begin(), truth.end()) ==
           std::set(result.named.begin(), result.named.end());
  }
  return result.outcome != Outcome::confusable && truth.size() == 1 &&
         truth.front() == outcome_name(result.outcome);
}

bool is_class_right(const Answer& answer, const std::string& first, const EffectClasses& classes) {
  const auto said = classes.find(first);
  return said != classes.end() &&
         std::ranges::any_of(answer.effects, [&](const HiddenEffect& effect) {
           return effect.effect_class == said->second;
         });
}

}  // namespace

std::vector<std::string> true_answers(const Answer& answer) {
  if (answer.effects.empty()) return {std::string(kNone)};
  if (answer.block == Block::out_of_catalogue) return {std::string(kUnknown)};
  std::vector<std::string> truth;
  for (const HiddenEffect& effect : answer.effects) truth.push_back(effect.effect);
  return truth;
}

std::vector<std::string> ranking(const CaseResult& result, const Answer& answer) {
  const std::vector<std::string> truth = true_answers(answer);
  std::vector<std::pair<double, std::string>> rest;
  for (const auto& [name, probability] : result.probabilities) {
    if (!contains(result.named, name)) rest.emplace_back(probability, name);
  }
  std::ranges::stable_sort(rest, [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first > b.first;
    return !contains(truth, a.second) && contains(truth, b.second);
  });
  std::vector<std::string> ranked = result.named;
  for (auto& [probability, name] : rest) ranked.push_back(std::move(name));
  const bool says_a_word = result.outcome == Outcome::none || result.outcome == Outcome::unknown;
  if (result.probabilities.empty() && says_a_word) {
    ranked.emplace_back(outcome_name(result.outcome));
  }
  return ranked;
}

std::vector<std::string> confusable_set(const CaseResult& result) {
  if (result.outcome != Outcome::confusable) return {};
  if (!result.confusable.empty()) return result.confusable;
  std::vector<std::string> members;
  for (const auto& [name, probability] : result.probabilities) {
    if (is_effect(name) && probability >= kSetMemberMin) members.push_back(name);
  }
  return members;
}

Judgement judge(const Answer& answer, const CaseResult& result, const EffectClasses& classes) {
  const std::vector<std::string> truth = true_answers(answer);
  const std::vector<std::string> ranked = ranking(result, answer);
  const std::vector<std::string> offered = confusable_set(result);
  const auto true_within = [&](std::span<const std::string> names) {
    return static_cast<int>(std::ranges::count_if(
        names, [&](const std::string& name) { return contains(truth, name); }));
  };
  const auto first = [&](std::size_t count) {
    return std::span(ranked).first(std::min(count, ranked.size()));
  };
  Judgement judgement;
  judgement.truth = truth_text(answer);
  judgement.said = said_text(result);
  judgement.right = is_right(answer, result);
  judgement.top1 = true_within(first(1)) > 0;
  judgement.top3 = true_within(first(3)) > 0;
  judgement.class_right = !ranked.empty() && is_class_right(answer, ranked.front(), classes);
  judgement.hidden_named = true_within(result.named);
  judgement.wrong_name = judgement.hidden_named < static_cast<int>(result.named.size());
  judgement.set_has_truth = true_within(offered) > 0;
  return judgement;
}

bool is_large(const Answer& answer) { return largest_share(answer) >= kLarge; }

ScoredCases cases_of_method(const AnswerKey& key, std::span<const CaseResult> results,
                            const std::string& method, const EffectClasses& classes) {
  ScoredCases cases;
  for (const CaseResult& result : results) {
    if (result.method != method) continue;
    const Answer& answer = key.at(result.case_id);
    cases.push_back({&answer, &result, judge(answer, result, classes)});
  }
  // Results come in the order in which the runs ended; scores must not depend on it.
  std::ranges::sort(cases, {}, [](const ScoredCase& scored) { return scored.answer->case_id; });
  return cases;
}

Result<void> check_cases_known(const AnswerKey& key, std::span<const CaseResult> results) {
  for (const CaseResult& result : results) {
    if (!key.contains(result.case_id)) {
      return failure(ErrorCode::not_found,
                     fmt::format("the results of method {} name the case {}, to which there is no "
                                 "answer; results of another population?",
                                 result.method, result.case_id));
    }
  }
  return {};
}

Result<EffectClasses> classes_of(const AnswerKey& key, EffectClasses listed) {
  for (const auto& [case_id, answer] : key) {
    for (const HiddenEffect& effect : answer.effects) {
      const auto [known, is_new] = listed.try_emplace(effect.effect, effect.effect_class);
      if (!is_new && known->second != effect.effect_class) {
        return failure(ErrorCode::invalid_value,
                       fmt::format("answer {}: effect {} is of class {}, but of class {} elsewhere",
                                   case_id, effect.effect, effect.effect_class, known->second));
      }
    }
  }
  return listed;
}

}  // namespace recald::blind
