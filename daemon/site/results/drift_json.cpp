#include "daemon/site/results/drift_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/site/results/drift_words.hpp"
#include "daemon/site/results/json_number.hpp"

namespace recald::daemon {
namespace {

// Keys in the order they are written: files are read by people too.
using Json = nlohmann::ordered_json;

Json record_json(const drift::ForecastRecord& record, const std::string& month) {
  return {{"month", month},
          {"measured", json_number(record.measured)},
          {"mean", json_number(record.mean)},
          {"sd", json_number(record.sd)},
          {"q05", json_number(record.q05)},
          {"q50", json_number(record.q50)},
          {"q95", json_number(record.q95)},
          {"pit", json_number(record.surprise.pit)},
          {"standardised", json_number(record.surprise.standardised)},
          {"log_score", json_number(record.surprise.log_score)},
          {"crps", json_number(record.surprise.crps)}};
}

Json state_json(const drift::WatchState& state) {
  Json json = {{"log_evidence", json_number(state.log_evidence)},
               {"log_threshold", json_number(state.log_threshold)},
               {"cusum_upper", json_number(state.cusum_upper)},
               {"cusum_lower", json_number(state.cusum_lower)},
               {"change_within_year", json_number(state.change_within_year)},
               {"calibration", nullptr}};
  if (const auto& check = state.calibration) {
    json["calibration"] = {{"mean", json_number(check->mean)},
                           {"sd", json_number(check->sd)},
                           {"lag_one", json_number(check->lag_one)},
                           {"pvalue", json_number(check->pvalue)}};
  }
  return json;
}

Json daily_json(const std::optional<DailyState>& daily) {
  if (!daily) return nullptr;
  return {{"log_evidence", json_number(daily->log_evidence)},
          {"log_threshold", json_number(daily->log_threshold)},
          {"lag_one", json_number(daily->lag_one)},
          {"month_factor", json_number(daily->month_factor)}};
}

Json days_json(const std::optional<drift::AlarmDays>& days) {
  if (!days) return nullptr;
  return {{"raised", metering::to_string(days->raised)},
          {"since", metering::to_string(days->since)},
          {"since_earliest", metering::to_string(days->since_earliest)},
          {"since_latest", metering::to_string(days->since_latest)},
          {"excess", json_number(days->excess)}};
}

Json outputs_json(const SiteDrift& drift) {
  Json list = Json::array();
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    const FollowedOutput& output = drift.outputs[k];
    Json months = Json::array();
    for (const drift::PrequentialMonth& month : drift.record) {
      if (!month.outputs[k]) continue;
      months.push_back(record_json(*month.outputs[k], drift.month_name(month.month)));
    }
    list.push_back({{"name", output.name},
                    {"meter", output.meter},
                    {"unit", output.unit},
                    {"forecast_by", output.by_level ? "level" : "model"},
                    {"state", state_json(output.state)},
                    {"daily", daily_json(output.daily)},
                    {"months", months}});
  }
  return list;
}

const char* kind_word(drift::CauseKind kind) {
  switch (kind) {
    case drift::CauseKind::nothing:
      return "nothing";
    case drift::CauseKind::parameter:
      return "parameter";
    case drift::CauseKind::direction:
      return "use";
    case drift::CauseKind::meter:
      return "meter";
    case drift::CauseKind::unknown:
      return "unknown";
  }
  return "unknown";
}

/// The parameter, use or meter that a cause speaks of.
Json subject_json(const SiteDrift& drift, const drift::Cause& cause) {
  const auto at = static_cast<std::size_t>(cause.index);
  switch (cause.kind) {
    case drift::CauseKind::parameter:
      return drift.parameters[at].name;
    case drift::CauseKind::direction:
      return drift.directions[at].name;
    case drift::CauseKind::unknown:
      return cause.index < 0 ? Json(nullptr) : Json(drift.outputs[at].name);
    case drift::CauseKind::meter:
      return drift.outputs[at].name;
    case drift::CauseKind::nothing:
      break;
  }
  return nullptr;
}

Json causes_json(const SiteDrift& drift, const ExplainedAlarm& alarm) {
  Json list = Json::array();
  for (const drift::Cause& cause : alarm.causes) {
    list.push_back({{"kind", kind_word(cause.kind)},
                    {"subject", subject_json(drift, cause)},
                    {"probability", json_number(cause.probability)},
                    {"log_evidence", json_number(cause.log_evidence)},
                    {"mean", json_number(cause.mean)},
                    {"q05", json_number(cause.q05)},
                    {"q95", json_number(cause.q95)},
                    {"words", cause_words(drift, cause)}});
  }
  return list;
}

const char* consequence_word(ExplainedAlarm::Consequence consequence) {
  switch (consequence) {
    case ExplainedAlarm::Consequence::none:
      return "none";
    case ExplainedAlarm::Consequence::began_anew:
      return "began_anew";
    case ExplainedAlarm::Consequence::meter_set_aside:
      return "meter_set_aside";
  }
  return "none";
}

Json alarms_json(const SiteDrift& drift) {
  Json list = Json::array();
  for (const ExplainedAlarm& explained : drift.alarms) {
    const drift::Alarm& alarm = explained.alarm;
    list.push_back({{"month", drift.month_name(alarm.month)},
                    {"output", drift.outputs[static_cast<std::size_t>(alarm.output)].name},
                    {"direction", alarm.direction > 0 ? "more" : "less"},
                    {"evidence", json_number(alarm.evidence)},
                    {"since", drift.month_name(alarm.since)},
                    {"since_earliest", drift.month_name(alarm.since_earliest)},
                    {"since_latest", drift.month_name(alarm.since_latest)},
                    {"days", days_json(alarm.days)},
                    {"forecasts_are_true", alarm.is_calibrated},
                    {"causes", causes_json(drift, explained)},
                    {"explained_until", drift.month_name(explained.explained_until)},
                    {"consequence", consequence_word(explained.consequence)},
                    {"sentence", explained_sentence(drift, explained)}});
  }
  return list;
}

Json windows_json(const SiteDrift& drift) {
  Json list = Json::array();
  const auto first = static_cast<std::size_t>(drift.learning_months - 1);
  for (const FollowedWindow& window : drift.windows) {
    Json parameters = Json::array();
    for (std::size_t j = 0; j < window.paths.size(); ++j) {
      Json months = Json::array();
      for (std::size_t i = 0; i < window.paths[j].mean.size(); ++i) {
        months.push_back({{"month", drift.months[first + i]},
                          {"mean", json_number(window.paths[j].mean[i])},
                          {"q05", json_number(window.paths[j].q05[i])},
                          {"q95", json_number(window.paths[j].q95[i])}});
      }
      parameters.push_back({{"name", drift.parameters[j].name},
                            {"unit", drift.parameters[j].unit},
                            {"months", months}});
    }
    int anew = 0;
    for (const drift::MonthTaken& taken : window.taken) anew += taken.anew ? 1 : 0;
    list.push_back({{"name", window.name},
                    {"log_score", json_number(window.log_score)},
                    {"sampled_anew", anew},
                    {"parameters", parameters}});
  }
  return list;
}

Json shifts_json(const SiteDrift& drift) {
  Json list = Json::array();
  for (std::size_t j = 0; j < drift.last_year.size(); ++j) {
    const drift::Shift& shift = drift.last_year[j];
    list.push_back({{"name", drift.parameters[j].name},
                    {"standardised", json_number(shift.standardised)},
                    {"hellinger", json_number(shift.hellinger)},
                    {"wasserstein", json_number(shift.wasserstein)},
                    {"probability_of_increase", json_number(shift.increased)},
                    {"pvalue", json_number(shift.pvalue)}});
  }
  return list;
}

Json meter_changes_json(const SiteDrift& drift) {
  Json list = Json::array();
  for (const MeterChange& change : drift.meter_changes) {
    const bool is_unit = change.kind == MeterChange::Kind::unit;
    list.push_back({{"meter", change.meter},
                    {"kind", is_unit ? "unit" : "readings"},
                    {"since", change.since},
                    {"seen", change.seen},
                    {"factor", json_number(change.factor)},
                    {"sentence", change.sentence}});
  }
  return list;
}

/// The newest month of an output, and how near the watches of its months and days are to an alarm.
Json newest_json(const SiteDrift& drift, std::size_t k) {
  const drift::WatchState& state = drift.outputs[k].state;
  Json json = {{"output", drift.outputs[k].name},
               {"month", nullptr},
               {"pvalue", nullptr},
               {"log_evidence", json_number(state.log_evidence)},
               {"log_threshold", json_number(state.log_threshold)},
               {"change_within_year", json_number(state.change_within_year)},
               {"daily", daily_json(drift.outputs[k].daily)}};
  for (const drift::PrequentialMonth& month : drift.record) {
    if (!month.outputs[k]) continue;
    const double pit = month.outputs[k]->surprise.pit;
    json["month"] = drift.month_name(month.month);
    json["pvalue"] = json_number(2.0 * std::min(pit, 1.0 - pit));
  }
  return json;
}

}  // namespace

std::string with_drift(const std::string& calibration, const SiteDrift& drift) {
  Json json = Json::parse(calibration);
  json["drift"] = Json::array();
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    json["drift"].push_back(newest_json(drift, k));
  }
  json["alarms"] = alarms_json(drift);
  json["meter_changes"] = meter_changes_json(drift);
  return json.dump(2) + "\n";
}

std::string without_drift(const std::string& calibration, const std::string& why) {
  Json json = Json::parse(calibration);
  json["drift_not_followed"] = why;
  return json.dump(2) + "\n";
}

std::string drift_json(const SiteDrift& drift, const RunFacts& facts) {
  const Json json = {{"model", drift.model},
                     {"months", drift.months},
                     {"learning_months", drift.learning_months},
                     {"alarms", alarms_json(drift)},
                     {"meter_changes", meter_changes_json(drift)},
                     {"outputs", outputs_json(drift)},
                     {"windows", windows_json(drift)},
                     {"last_year", shifts_json(drift)},
                     {"warnings", drift.warnings},
                     {"seed", facts.seed},
                     {"data_revision", facts.data_revision},
                     {"model_version", facts.model_version},
                     {"recald_version", facts.recald_version},
                     {"tzdata", facts.time_zone_data},
                     {"wall_s", facts.wall_s}};
  return json.dump(2) + "\n";
}

}  // namespace recald::daemon
