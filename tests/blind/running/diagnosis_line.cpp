#include "tests/blind/running/diagnosis_line.hpp"

#include <algorithm>
#include <array>

#include "tests/blind/running/strength_of_answer.hpp"
#include "tests/blind/scoring/case_result.hpp"

namespace recald::blind {
namespace {

bool is_there(const Json& object, const char* key) {
  return object.contains(key) && !object.at(key).is_null();
}

/// In their order, each once: an effect of single meters may stand there for two of them.
template <class Values>
std::vector<std::string> distinct(const Values& values) {
  std::vector<std::string> names;
  for (const std::string& name : values) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<std::string> names_of(const Json& list) {
  return distinct(list.get<std::vector<std::string>>());
}

std::vector<std::string> names_under(const Json& list, const char* key) {
  std::vector<std::string> names;
  for (const Json& entry : list) names.push_back(entry.at(key).get<std::string>());
  return distinct(names);
}

/// Summed over the meters of one name. What a later pass added may have been no candidate of the
/// first, whose probabilities these are: then it had none.
Json probabilities_of(const Json& diagnosis, const std::vector<std::string>& added) {
  Json probabilities = Json::object();
  for (const Json& candidate : diagnosis.at("candidates")) {
    const auto effect = candidate.at("effect").get<std::string>();
    probabilities[effect] =
        probabilities.value(effect, 0.0) + candidate.at("probability").get<double>();
  }
  for (const std::string& effect : added) {
    if (!probabilities.contains(effect)) probabilities[effect] = 0.0;
  }
  return probabilities;
}

/// Of the hourly model, over meters whose four figures are there; null if none has them.
Json gap_of(const Json& diagnosis) {
  if (!is_there(diagnosis, "gap") || !is_there(diagnosis.at("gap"), "hourly")) return nullptr;
  const Json& hourly = diagnosis.at("gap").at("hourly");
  Json gap = {{"before", Json::object()}, {"after", Json::object()}};
  for (const auto& [meter, ignored] : hourly.at("before").items()) {
    const Json& before = hourly.at("before").at(meter);
    const Json& after = hourly.at("after").at(meter);
    const bool complete = std::ranges::all_of(std::array{&before, &after}, [](const Json* fit) {
      return is_there(*fit, "log_score") && is_there(*fit, "cvrmse");
    });
    if (!complete) continue;
    for (const char* when : {"before", "after"}) {
      const Json& fit = hourly.at(when).at(meter);
      gap[when][meter] = {{"log_score", fit.at("log_score")}, {"cvrmse", fit.at("cvrmse")}};
    }
  }
  return gap.at("before").empty() ? Json(nullptr) : gap;
}

/// Of all meters but the one that gained most: that is what the effect was added for. A sum over
/// months and its standard error; the scorer compares one with the other.
Json other_meters_of(const Json& diagnosis) {
  Json others = Json::object();
  if (!is_there(diagnosis, "gap") || !is_there(diagnosis.at("gap"), "hourly")) return others;
  std::string best;
  for (const auto& [meter, change] :
       diagnosis.at("gap").at("hourly").at("log_score_change").items()) {
    // With a single month there is no standard error, and nothing to tell harm from chance by.
    if (!is_there(change, "sum") || !is_there(change, "se") || change.at("se") == 0.0) continue;
    others[meter] = {{"mean", change.at("sum")}, {"se", change.at("se")}};
    if (best.empty() || others[meter].at("mean") > others[best].at("mean")) best = meter;
  }
  if (!best.empty()) others.erase(best);
  return others;
}

Json posteriors_of(const Json& list) {
  Json posteriors = Json::object();
  for (const Json& p : list) {
    posteriors[p.at("name").get<std::string>()] = {
        {"mean", p.contains("mean") ? p.at("mean") : p.at("mode")},
        {"q05", p.at("q05")},
        {"q95", p.at("q95")}};
  }
  return posteriors;
}

/// In the answer's terms where the parameter and the answer's strength are one quantity; else in
/// its own unit, which the scorer counts and leaves out.
Json effect_interval_of(const Json& addition) {
  const Json& parameters = addition.at("parameters");
  if (parameters.empty()) return nullptr;
  const StrengthOfAnswer* known = strength_of_answer(addition.at("effect").get<std::string>());
  const auto found = std::ranges::find_if(parameters, [&](const Json& p) {
    return known != nullptr && p.at("name") == known->parameter;
  });
  if (found == parameters.end()) {
    const Json& first = parameters.front();
    return {{"q05", first.at("q05")}, {"q95", first.at("q95")}, {"unit", first.at("unit")}};
  }
  const double one = known->strength(found->at("q05").get<double>());
  const double other = known->strength(found->at("q95").get<double>());
  return {{"q05", std::min(one, other)}, {"q95", std::max(one, other)}, {"unit", known->unit}};
}

void add_posteriors(const Json& diagnosis, Json& line) {
  for (const char* key : {"parameters_before", "parameters_after"}) {
    if (is_there(diagnosis, key)) line[key] = posteriors_of(diagnosis.at(key));
  }
}

/// Beside wall time the processor's, which does not depend on what else the machine had to do.
void add_cost(const CaseRun& run, Json& line) {
  line["wall_s"] = run.wall_s;
  line["peak_rss_MB"] = run.peak_rss_MB;
  line["extra"]["cpu_s"] = run.cpu_s;
}

void add_facts(const Json& diagnosis, const CaseRun& run, Json& line) {
  line["located"] = Json::array();
  for (const std::string& meter : names_under(diagnosis.at("located"), "meter")) {
    line["located"].push_back({{"meter", meter}});
  }
  line["extra"] = {{"why", diagnosis.at("why")}, {"seed", diagnosis.at("seed")}};
  add_cost(run, line);
}

Json translate(const Json& diagnosis, const CaseRun& run) {
  const auto outcome = diagnosis.at("outcome").get<std::string>();
  const std::vector<std::string> added = names_of(diagnosis.at("added"));
  Json line = line_head(run, outcome);
  line["named"] = added;
  if (outcome == "confusable") line["confusable"] = names_of(diagnosis.at("confusable"));
  line["probabilities"] = probabilities_of(diagnosis, added);
  add_posteriors(diagnosis, line);
  add_facts(diagnosis, run, line);
  if (added.empty()) {
    line["extra"]["taken_back"] = names_under(diagnosis.at("additions"), "effect");
    return line;
  }
  if (Json gap = gap_of(diagnosis); !gap.is_null()) line["gap"] = std::move(gap);
  line["other_meters_log_score_change"] = other_meters_of(diagnosis);
  Json interval = effect_interval_of(diagnosis.at("additions").front());
  if (!interval.is_null()) line["effect_parameter"] = std::move(interval);
  return line;
}

Json translate_oracle(const Json& diagnosis, const CaseRun& run,
                      const std::vector<std::string>& assumed) {
  Json line = line_head(run, "named");
  line["named"] = distinct(assumed);
  line["gap"] = gap_of(diagnosis);
  add_posteriors(diagnosis, line);
  add_facts(diagnosis, run, line);
  return line;
}

/// Whatever was read must be a line that the scorer takes.
Result<Json> checked(Json line) {
  const auto read = parse_case_result(line.dump(), "the line made of diagnosis.json");
  if (!read) return tl::unexpected(read.error());
  return line;
}

tl::unexpected<Error> not_understood(const Json::exception& error) {
  return failure(ErrorCode::malformed, std::string("diagnosis.json: ") + error.what());
}

}  // namespace

Json line_head(const CaseRun& run, std::string_view outcome) {
  return {{"case", run.case_id},
          {"method", run.method},
          {"outcome", outcome},
          {"named", Json::array()},
          {"version", run.version}};
}

Json failure_line(const CaseRun& run, const std::string& why) {
  Json line = line_head(run, "none");
  add_cost(run, line);
  line["extra"]["failed"] = why;
  return line;
}

Result<Json> diagnosis_line(const Json& diagnosis, const CaseRun& run) {
  try {
    return checked(translate(diagnosis, run));
  } catch (const Json::exception& error) {
    return not_understood(error);
  }
}

Result<Json> oracle_line(const Json& diagnosis, const CaseRun& run,
                         const std::vector<std::string>& assumed) {
  try {
    Json line = translate_oracle(diagnosis, run, assumed);
    if (line.at("gap").is_null()) {
      return failure(ErrorCode::not_found, "diagnosis.json has no gap of the hourly model");
    }
    return checked(std::move(line));
  } catch (const Json::exception& error) {
    return not_understood(error);
  }
}

}  // namespace recald::blind
