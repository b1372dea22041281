#include "tests/blind/running/drift_line.hpp"

#include <fmt/format.h>

namespace recald::blind {
namespace {

/// drift.json and the line call the likeliest cause alike, apart from an alarm that gives none.
Json alarm_of(const Json& alarm) {
  Json told{
      {"month", alarm.at("month")}, {"kind", "nothing"}, {"subject", ""}, {"probability", 0.0}};
  const Json& causes = alarm.at("causes");
  if (causes.empty()) return told;
  const Json& first = causes.front();
  told["kind"] = first.at("kind");
  if (first.at("subject").is_string()) told["subject"] = first["subject"];
  told["probability"] = first.at("probability");
  return told;
}

/// A changed unit, or readings that were lost or stand still.
Json changed_meter_of(const Json& change) {
  return {{"month", change.at("seen")},
          {"kind", "meter"},
          {"subject", change.at("meter")},
          {"probability", 1.0}};
}

}  // namespace

Result<Json> drift_line(const Json& drift, const CaseRun& run) try {
  const Json& months = drift.at("months");
  const auto learnt = drift.at("learning_months").get<std::size_t>();
  if (learnt >= months.size()) {
    return failure(ErrorCode::malformed, "drift.json watches no month");
  }
  Json alarms = Json::array();
  for (const Json& alarm : drift.at("alarms")) alarms.push_back(alarm_of(alarm));
  for (const Json& change : drift.at("meter_changes")) {
    if (change.at("seen") >= months[learnt]) alarms.push_back(changed_meter_of(change));
  }
  Json line = line_head(run, "none");
  line["drift"] = {{"from", months[learnt]}, {"to", months.back()}, {"alarms", alarms}};
  line["wall_s"] = run.wall_s;
  line["peak_rss_MB"] = run.peak_rss_MB;
  line["extra"]["cpu_s"] = run.cpu_s;
  return line;
} catch (const Json::exception& error) {
  return failure(ErrorCode::malformed, fmt::format("drift.json: {}", error.what()));
}

}  // namespace recald::blind
