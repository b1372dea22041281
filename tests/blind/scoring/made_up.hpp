/// Made-up answers and results, as short to write as the scores are to compute by hand.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/blind/scoring/scored_case.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::blind::made_up {

inline HiddenEffect effect(std::string id, std::string effect_class = "schedules") {
  return {.effect = std::move(id),
          .effect_class = std::move(effect_class),
          .in_catalogue = true,
          .strength = 3.0,
          .unit = "h",
          .share_of_meter = {{"electricity", 0.03}, {"steam", -0.10}}};
}

inline Answer nothing_hidden(std::string case_id) {
  return {.case_id = std::move(case_id),
          .block = Block::no_effect,
          .climate = "cold",
          .use = "office",
          .true_parameters = {{"cooling_setpoint_C", 24.0}, {"occupancy", 1.0}},
          .prior_sd = {{"cooling_setpoint_C", 2.0}, {"occupancy", 0.5}}};
}

/// An effect that moves so much of electricity.
inline HiddenEffect moving(std::string id, double share) {
  HiddenEffect hidden = effect(std::move(id));
  hidden.moved_share = {{"electricity", share}, {"steam", 0.0}};
  return hidden;
}

inline Answer single(std::string case_id, HiddenEffect hidden) {
  Answer answer = nothing_hidden(std::move(case_id));
  answer.block = Block::single;
  answer.effects = {std::move(hidden)};
  return answer;
}

inline Answer pair(std::string case_id, HiddenEffect one, HiddenEffect other) {
  Answer answer = nothing_hidden(std::move(case_id));
  answer.block = Block::pair;
  answer.effects = {std::move(one), std::move(other)};
  return answer;
}

inline Answer outside(std::string case_id, std::string id) {
  Answer answer = nothing_hidden(std::move(case_id));
  answer.block = Block::out_of_catalogue;
  answer.effects = {effect(std::move(id))};
  answer.effects.front().in_catalogue = false;
  return answer;
}

inline Answer decoy_only(std::string case_id) {
  Answer answer = nothing_hidden(std::move(case_id));
  answer.block = Block::out_of_catalogue;
  answer.decoys = {"neighbour_meter"};
  return answer;
}

inline CaseResult said(std::string case_id, Outcome outcome,
                       std::map<std::string, double> probabilities = {},
                       std::string method = "recald") {
  return {.case_id = std::move(case_id),
          .method = std::move(method),
          .outcome = outcome,
          .probabilities = std::move(probabilities)};
}

inline CaseResult named(std::string case_id, std::vector<std::string> names,
                        std::map<std::string, double> probabilities = {},
                        std::string method = "recald") {
  CaseResult result =
      said(std::move(case_id), Outcome::named, std::move(probabilities), std::move(method));
  result.named = std::move(names);
  return result;
}

/// A population and what was said about it; holds what the scored cases point to.
class Population {
 public:
  void add(Answer answer, CaseResult result) {
    results_.push_back(std::move(result));
    std::string id = answer.case_id;
    key_.emplace(std::move(id), std::move(answer));
  }
  /// What another method said of a case that is there already.
  void add(CaseResult result) { results_.push_back(std::move(result)); }

  [[nodiscard]] const AnswerKey& key() const { return key_; }
  [[nodiscard]] const std::vector<CaseResult>& results() const { return results_; }
  [[nodiscard]] EffectClasses classes() const { return classes_of(key_, {}).value(); }
  [[nodiscard]] ScoredCases cases(const std::string& method = "recald") const {
    return cases_of_method(key_, results_, method, classes());
  }

 private:
  AnswerKey key_;
  std::vector<CaseResult> results_;
};

/// An answer file as the population maker writes it.
inline nlohmann::json answer_json(const std::string& case_id) {
  return {{"case", case_id},
          {"block", "single"},
          {"effects",
           {{{"effect", "night_setback_missing"},
             {"class", "schedules"},
             {"in_catalogue", true},
             {"strength", 3.0},
             {"unit", "K"},
             {"from", "2022-03-01"},
             {"to", nullptr},
             {"share_of_meter", {{"electricity", 0.01}, {"steam", 0.09}}}}}},
          {"decoys", nlohmann::json::array()},
          {"climate", "hot-humid"},
          {"use", "office"},
          {"gaps", false},
          {"true_parameters", {{"cooling_setpoint_C", 24.3}}},
          {"prior_sd", {{"cooling_setpoint_C", 1.5}}}};
}

/// A result line with every key.
inline nlohmann::json result_json(const std::string& case_id) {
  const nlohmann::json fit{{"steam", {{"log_score", -2.0}, {"cvrmse", 0.2}}}};
  const nlohmann::json posterior{
      {"cooling_setpoint_C", {{"mean", 24.0}, {"q05", 23.0}, {"q95", 25.0}}}};
  return {{"case", case_id},
          {"method", "recald"},
          {"outcome", "named"},
          {"named", {"night_setback_missing"}},
          {"probabilities", {{"night_setback_missing", 0.9}, {"none", 0.06}, {"unknown", 0.04}}},
          {"gap", {{"before", fit}, {"after", fit}, {"oracle", fit}}},
          {"other_meters_log_score_change", {{"electricity", {{"mean", 0.0}, {"se", 0.1}}}}},
          {"parameters_before", posterior},
          {"parameters_after", posterior},
          {"effect_parameter", {{"q05", 2.0}, {"q95", 4.0}}},
          {"located", {{{"meter", "steam"}}}},
          {"wall_s", 12.5},
          {"peak_rss_MB", 80.0},
          {"version", "recald 0.1.0"}};
}

}  // namespace recald::blind::made_up
