#include "tests/blind/scoring/case_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/blind/scoring/json_fields.hpp"

namespace recald::blind {
namespace {

// In the order of the enumeration.
constexpr std::array<std::string_view, 4> kOutcomes{"named", "confusable", "unknown", "none"};

// "extra" is free for whatever else a method wants to keep; nothing of it is scored.
constexpr std::array<std::string_view, 18> kKeys{"case",
                                                 "method",
                                                 "outcome",
                                                 "named",
                                                 "confusable",
                                                 "probabilities",
                                                 "gap",
                                                 "other_meters_log_score_change",
                                                 "parameters_before",
                                                 "parameters_after",
                                                 "effect_parameter",
                                                 "calibration",
                                                 "drift",
                                                 "located",
                                                 "wall_s",
                                                 "peak_rss_MB",
                                                 "version",
                                                 "extra"};

FitOfMeter read_fits(JsonFields& gap, std::string_view key) {
  FitOfMeter fits;
  gap.each(key, [&](const std::string& meter, JsonFields& fields) {
    fits[meter] = {.log_score = fields.number("log_score"),
                   .cvrmse = fields.number("cvrmse", {.min = 0.0})};
  });
  return fits;
}

bool same_meters(const FitOfMeter& a, const FitOfMeter& b) {
  return std::ranges::equal(a, b, {}, &FitOfMeter::value_type::first,
                            &FitOfMeter::value_type::first);
}

Gap read_gap(JsonFields& fields) {
  Gap gap{.before = read_fits(fields, "before"), .after = read_fits(fields, "after")};
  if (fields.has("oracle")) gap.oracle = read_fits(fields, "oracle");
  if (gap.before.empty()) fields.fail("'gap.before' has no meter");
  if (!same_meters(gap.before, gap.after) ||
      (gap.oracle && !same_meters(gap.before, *gap.oracle))) {
    fields.fail("'gap' has different meters before, after and for the oracle");
  }
  return gap;
}

std::map<std::string, Posterior> read_posteriors(JsonFields& line, std::string_view key) {
  std::map<std::string, Posterior> posteriors;
  if (!line.has(key)) return posteriors;
  line.each(key, [&](const std::string& name, JsonFields& fields) {
    const Posterior read{
        .mean = fields.number("mean"), .q05 = fields.number("q05"), .q95 = fields.number("q95")};
    if (read.q05 > read.q95) fields.fail(fmt::format("'{}.{}' has q05 above q95", key, name));
    posteriors[name] = read;
  });
  return posteriors;
}

EffectInterval read_interval(JsonFields& fields) {
  EffectInterval interval{.q05 = fields.number("q05"), .q95 = fields.number("q95")};
  if (fields.has("unit")) interval.unit = fields.text("unit");
  if (interval.q05 > interval.q95) fields.fail("'effect_parameter' has q05 above q95");
  return interval;
}

void read_probabilities(JsonFields& line, CaseResult& result) {
  if (!line.has("probabilities")) return;
  result.probabilities = line.numbers("probabilities", {.min = 0.0, .max = 1.0});
  double sum = 0.0;
  for (const auto& [name, probability] : result.probabilities) sum += probability;
  if (std::abs(sum - 1.0) > kProbabilitySumTolerance) {
    line.fail(fmt::format("'probabilities' sum to {:.6g}, must sum to 1", sum));
  }
  for (const std::string& name : result.named) {
    if (!result.probabilities.contains(name)) {
      line.fail("'named' has '" + name + "', to which 'probabilities' gives none");
    }
  }
}

void read_said(JsonFields& line, CaseResult& result) {
  const std::string outcome = line.word("outcome", kOutcomes);
  const auto found = std::ranges::find(kOutcomes, outcome);
  if (found != kOutcomes.end()) result.outcome = static_cast<Outcome>(found - kOutcomes.begin());
  result.named = line.names("named");
  if (line.has("confusable")) result.confusable = line.names("confusable");
  for (const auto* list : {&result.named, &result.confusable}) {
    for (const std::string& name : *list) {
      if (name == kNone || name == kUnknown)
        line.fail("'" + name + "' is not the name of an effect");
    }
  }
  if ((result.outcome == Outcome::named) == result.named.empty()) {
    line.fail(
        fmt::format("'outcome' is '{}' with {} effects in 'named'; it is 'named' exactly if "
                    "an effect was added",
                    outcome, result.named.size()));
  }
}

/// "2022-03"
std::string read_month(JsonFields& fields, std::string_view key) {
  std::string month = fields.name(key);
  constexpr std::size_t kLength = 7;
  if (month.size() != kLength || month[4] != '-') {
    fields.fail(fmt::format("'{}' is '{}', must be a month such as 2022-03", key, month));
    return "2000-01";
  }
  return month;
}

Drift read_drift(JsonFields& fields) {
  constexpr std::array<std::string_view, 5> kKinds{"meter", "parameter", "use", "unknown",
                                                   "nothing"};
  Drift drift{.from = read_month(fields, "from"), .to = read_month(fields, "to")};
  fields.each("alarms", [&](const std::string&, JsonFields& alarm) {
    drift.alarms.push_back({.month = read_month(alarm, "month"),
                            .kind = alarm.word("kind", kKinds),
                            .subject = alarm.text("subject"),
                            .probability = alarm.number("probability", {.min = 0.0, .max = 1.0})});
  });
  return drift;
}

void read_fit(JsonFields& line, CaseResult& result) {
  if (line.has("gap")) {
    line.object("gap", [&](JsonFields& fields) { result.gap = read_gap(fields); });
  }
  if (line.has("other_meters_log_score_change")) {
    line.each("other_meters_log_score_change", [&](const std::string& meter, JsonFields& fields) {
      result.other_meters[meter] = {.mean = fields.number("mean"),
                                    .se = fields.number("se", {.min = 0.0})};
    });
  }
  if (line.has("calibration")) {
    line.each("calibration", [&](const std::string& meter, JsonFields& fields) {
      const NumberRange positive{.min = 0.0};
      result.calibration[meter] = {.before = fields.number("before", positive),
                                   .after = fields.number("after", positive),
                                   .forecast = fields.number("forecast", positive),
                                   .yardstick = fields.number("yardstick", positive)};
    });
  }
  if (line.has("drift")) {
    line.object("drift", [&](JsonFields& fields) { result.drift = read_drift(fields); });
  }
  result.parameters_before = read_posteriors(line, "parameters_before");
  result.parameters_after = read_posteriors(line, "parameters_after");
  if (line.has("effect_parameter")) {
    line.object("effect_parameter",
                [&](JsonFields& fields) { result.effect_parameter = read_interval(fields); });
  }
}

void read_cost(JsonFields& line, CaseResult& result) {
  if (line.has("located")) {
    result.located.emplace();
    line.each("located", [&](const std::string&, JsonFields& fields) {
      result.located->push_back(fields.name("meter"));
    });
  }
  if (line.has("wall_s")) result.wall_s = line.number("wall_s", {.min = 0.0});
  if (line.has("peak_rss_MB")) result.peak_rss_MB = line.number("peak_rss_MB", {.min = 0.0});
  if (line.has("version")) result.version = line.text("version");
}

}  // namespace

std::string_view outcome_name(Outcome outcome) {
  return kOutcomes[static_cast<std::size_t>(outcome)];
}

Result<CaseResult> parse_case_result(std::string_view line, const std::string& where) {
  const auto parsed = parse_json(line, where);
  if (!parsed) return tl::unexpected(parsed.error());

  CaseResult result;
  JsonFields head(*parsed, where);
  result.case_id = head.name("case");
  result.method = head.name("method");
  if (head.error()) return tl::unexpected(*head.error());

  JsonFields fields(*parsed, fmt::format("{}, case {}", where, result.case_id));
  fields.only(kKeys);
  read_said(fields, result);
  read_probabilities(fields, result);
  read_fit(fields, result);
  read_cost(fields, result);
  if (fields.error()) return tl::unexpected(*fields.error());
  return result;
}

}  // namespace recald::blind
