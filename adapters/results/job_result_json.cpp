#include "adapters/results/job_result_json.hpp"

#include <cmath>
#include <utility>

#include "adapters/shapes/shape_json.hpp"

namespace recald::results {
namespace {

/// Of a calibration's parameter, all that is read.
struct Sampled {
  double rhat = kAbsent;
};

}  // namespace
}  // namespace recald::results

SHAPE(recald::DailyEvidence, log_evidence, log_threshold, lag_one, month_factor);
SHAPE(recald::OutputDrift, output, month, pvalue, log_evidence, log_threshold, change_within_year,
      daily);
SHAPE(recald::AlarmedDays, raised, since, since_earliest, since_latest, excess);
namespace recald::shapes {

using drift::CauseKind;
using drift::Consequence;
using drift::MeterChangeKind;

// What a later recald may write: an unknown cause, and no consequence that is known here.
template <>
struct Form<CauseKind>
    : Words<CauseKind, CauseKind::unknown, CauseKind::nothing, CauseKind::parameter,
            CauseKind::direction, CauseKind::meter, CauseKind::effect> {};
template <>
struct Form<Consequence>
    : Words<Consequence, Consequence::none, Consequence::began_anew, Consequence::meter_set_aside> {
};
template <>
struct Form<MeterChangeKind>
    : Words<MeterChangeKind, MeterChangeKind::readings, MeterChangeKind::unit> {};

}  // namespace recald::shapes

SHAPE(recald::AlarmCause, kind, subject, probability, log_evidence, mean, q05, q95, words);
SHAPE(recald::DriftAlarm, month, output, direction, evidence, since, since_earliest, since_latest,
      days, forecasts_are_true, causes, explained_until, consequence, sentence);
SHAPE(recald::ChangedMeter, meter, kind, since, seen, factor, sentence);
SHAPE(recald::MonthWeather, month, known, from);
SHAPE(recald::results::Sampled, rhat);

namespace recald::results {

using shapes::Json;

Json number(double value) { return shapes::json_of(value); }

Json outputs_json(const DriftSummary& drift) {
  Json list = shapes::json_of(drift.outputs);
  for (Json& one : list) {
    if (one["month"] == "") one["month"] = nullptr;  // there was no forecast
  }
  return list;
}

Json alarms_json(const DriftSummary& drift) { return shapes::json_of(drift.alarms); }

Json changed_meters_json(const DriftSummary& drift) {
  return shapes::json_of(drift.changed_meters);
}

Json weather_json(const std::vector<MonthWeather>& months) { return shapes::json_of(months); }

JobResult read_job_result(std::string document) {
  JobResult result{.document = std::move(document), .rhat_max = kAbsent, .drift = {}};
  const Json json = Json::parse(result.document, nullptr, false);
  if (!json.is_object()) return result;
  const auto read = [&](const char* key, auto& list) {
    return json.contains(key) && shapes::read(json[key], list);
  };
  for (const char* group : {"parameters", "hyperparameters"}) {
    std::vector<Sampled> all;
    read(group, all);
    for (const Sampled& one : all) result.rhat_max = std::fmax(result.rhat_max, one.rhat);
  }
  read("weather", result.weather);
  DriftSummary drift;
  const bool has_outputs = read("drift", drift.outputs);
  const bool has_alarms = read("alarms", drift.alarms);
  if (!has_outputs && !has_alarms) return result;
  read("meter_changes", drift.changed_meters);
  result.drift = std::move(drift);
  return result;
}

}  // namespace recald::results
