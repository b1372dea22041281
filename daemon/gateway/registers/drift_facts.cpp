#include "daemon/gateway/registers/drift_facts.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace recald::daemon {
namespace {

constexpr double kRising = 0.5;  // of the threshold

bool is_output_of(const std::string& output, const std::string& meter) {
  return output == meter + "_daily_kWh" || output == meter + "_peak_kW";
}

/// "2024-03", or a day of it.
std::optional<metering::Month> month_in(const std::string& text) {
  const auto month = metering::parse_month(text.substr(0, 7));
  return month ? std::optional{*month} : std::nullopt;
}

std::string newest_month(const DriftSummary& drift) {
  std::string newest;
  for (const OutputDrift& one : drift.outputs) newest = std::max(newest, one.month);
  return newest;
}

void add_evidence(DriftFacts& facts, const OutputDrift& output) {
  facts.evidence = std::fmax(facts.evidence, output.log_evidence / output.log_threshold);
  if (output.daily) {
    facts.evidence =
        std::fmax(facts.evidence, output.daily->log_evidence / output.daily->log_threshold);
  }
  facts.state = facts.evidence >= kRising ? DriftState::rising : DriftState::as_forecast;
}

void add_alarm(DriftFacts& facts, const DriftAlarm& alarm, const std::string& newest) {
  const bool is_set_aside = alarm.consequence == drift::Consequence::meter_set_aside;
  const bool is_open = alarm.month == newest || (alarm.consequence == drift::Consequence::none &&
                                                 alarm.explained_until == newest);
  if (!is_open && !is_set_aside) return;
  facts.state = is_set_aside ? DriftState::set_aside : DriftState::alarm;
  facts.since = month_in(alarm.since);
  facts.alarm = AlarmCode::unknown;
  if (alarm.causes.empty()) return;
  const AlarmCause& likeliest = alarm.causes.front();
  facts.alarm = alarm_code(likeliest.kind, likeliest.subject.value_or(""));
  facts.probability = likeliest.probability;
}

}  // namespace

DriftFacts drift_of(const DriftSummary& drift, const std::string& meter) {
  DriftFacts facts;
  for (const OutputDrift& output : drift.outputs) {
    if (is_output_of(output.output, meter)) add_evidence(facts, output);
  }
  const std::string newest = newest_month(drift);
  for (const ChangedMeter& changed : drift.changed_meters) {
    if (changed.meter != meter || !changed.seen.starts_with(newest)) continue;
    facts.state = DriftState::alarm;
    facts.alarm = AlarmCode::meter;
    facts.since = month_in(changed.since);
  }
  for (const DriftAlarm& alarm : drift.alarms) {  // the newest last
    if (is_output_of(alarm.output, meter)) add_alarm(facts, alarm, newest);
  }
  return facts;
}

AlarmCode named_in(const std::string& document) {
  const auto json = nlohmann::json::parse(document, nullptr, false);
  if (!json.is_object()) return AlarmCode::none;
  const auto added = json.find("added");
  if (added == json.end() || !added->is_array() || added->empty() || !(*added)[0].is_string()) {
    return AlarmCode::none;
  }
  return alarm_code(drift::CauseKind::effect, (*added)[0].get<std::string>());
}

}  // namespace recald::daemon
