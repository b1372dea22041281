#include "tests/blind/running/baseline_lines.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "tests/blind/scoring/case_result.hpp"

namespace recald::blind {
namespace {

constexpr double kLeastLogBayesFactor = 5.0;
// Prior odds as the diagnosis has them (core/diagnosis/naming.hpp).
constexpr double kPriorNone = 0.5;
constexpr double kPriorUnknown = 0.1;

using LogWeights = std::map<std::string, double>;

/// Two meters or datings of one effect share its name: the better one speaks for it.
void keep_best(LogWeights& weights, const std::string& name, double log_weight) {
  const auto [place, is_new] = weights.try_emplace(name, log_weight);
  if (!is_new) place->second = std::max(place->second, log_weight);
}

Json normalised(const LogWeights& weights) {
  const auto second = &LogWeights::value_type::second;
  const double top = std::ranges::max_element(weights, {}, second)->second;
  double sum = 0.0;
  for (const auto& [name, log_weight] : weights) sum += std::exp(log_weight - top);
  Json probabilities = Json::object();
  for (const auto& [name, log_weight] : weights) {
    probabilities[name] = std::exp(log_weight - top) / sum;
  }
  return probabilities;
}

/// The heaviest name if it is heavier than `least`.
Json named_line(const CaseRun& run, const LogWeights& effects, double least) {
  const auto best = std::ranges::max_element(effects, {}, &LogWeights::value_type::second);
  if (best == effects.end() || best->second <= least) {
    return line_head(run, outcome_name(Outcome::none));
  }
  Json line = line_head(run, outcome_name(Outcome::named));
  line["named"] = {best->first};
  return line;
}

std::optional<Json> aic_line(const Json& diagnosis, const CaseRun& run) {
  LogWeights weights;  // -AIC / 2, above the base model's
  for (const Json& candidate : diagnosis.at("candidates")) {
    if (!candidate.contains("parameters")) continue;  // none, unknown
    if (!candidate.contains("log_likelihood_gain")) return std::nullopt;
    const auto more_parameters = static_cast<double>(candidate.at("parameters").size());
    keep_best(weights, candidate.at("effect").get<std::string>(),
              candidate.at("log_likelihood_gain").get<double>() - more_parameters);
  }
  Json line = named_line(run, weights, 0.0);
  weights[std::string(kNone)] = 0.0;
  line["probabilities"] = normalised(weights);
  return line;
}

std::optional<Json> first_look_line(const Json& diagnosis, const CaseRun& run) {
  if (!diagnosis.contains("first_look")) return std::nullopt;
  LogWeights factors;
  for (const Json& look : diagnosis.at("first_look")) {
    keep_best(factors, look.at("effect").get<std::string>(),
              look.at("log_bayes_factor").get<double>());
  }
  Json line = named_line(run, factors, kLeastLogBayesFactor);
  const double prior_each =
      (1.0 - kPriorNone) / static_cast<double>(std::max(factors.size(), std::size_t{1}));
  for (auto& [name, factor] : factors) factor += std::log(prior_each);
  factors[std::string(kNone)] = std::log(kPriorNone);
  line["probabilities"] = normalised(factors);
  return line;
}

Json unknown_line(const Json& diagnosis, const CaseRun& run) {
  const auto gain = diagnosis.at("unknown_gain").get<double>();
  const bool unknown = gain > kLeastLogBayesFactor;
  Json line = line_head(run, outcome_name(unknown ? Outcome::unknown : Outcome::none));
  line["probabilities"] = normalised({{std::string(kNone), std::log(kPriorNone)},
                                      {std::string(kUnknown), std::log(kPriorUnknown) + gain}});
  return line;
}

std::optional<Json> line_of(const Json& diagnosis, const CaseRun& run) {
  if (run.method == "aic") return aic_line(diagnosis, run);
  if (run.method == "first_look") return first_look_line(diagnosis, run);
  if (run.method == "unknown_only") return unknown_line(diagnosis, run);
  return line_head(run, outcome_name(Outcome::none));
}

}  // namespace

Result<Json> baseline_line(const Json& diagnosis, const CaseRun& run) {
  try {
    auto line = line_of(diagnosis, run);
    if (!line) {
      return failure(ErrorCode::not_found, "diagnosis.json lacks what " + run.method + " needs");
    }
    return std::move(*line);
  } catch (const Json::exception& error) {
    return failure(ErrorCode::malformed, std::string("diagnosis.json: ") + error.what());
  }
}

}  // namespace recald::blind
