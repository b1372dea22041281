#include "adapters/views/drift/drift_summary.hpp"

#include <algorithm>

#include "adapters/views/drift/drift_words.hpp"

namespace recald::views {
namespace {

/// The parameter, use, output or effect that a cause speaks of.
std::optional<std::string> subject_of(const drift::SiteDrift& drift, const drift::Cause& cause) {
  const auto at = static_cast<std::size_t>(cause.index);
  switch (cause.kind) {
    case drift::CauseKind::parameter:
      return drift.parameters[at].name;
    case drift::CauseKind::direction:
      return drift.directions[at].name;
    case drift::CauseKind::unknown:
      if (cause.index < 0) return std::nullopt;
      return drift.outputs[at].name;
    case drift::CauseKind::meter:
      return drift.outputs[at].name;
    case drift::CauseKind::effect:
      return cause.effect;
    case drift::CauseKind::nothing:
      break;
  }
  return std::nullopt;
}

DriftAlarm alarm_of(const drift::SiteDrift& drift, const drift::ExplainedAlarm& explained) {
  const drift::Alarm& alarm = explained.alarm;
  DriftAlarm row{.month = drift.month_name(alarm.month),
                 .output = drift.outputs[static_cast<std::size_t>(alarm.output)].name,
                 .direction = alarm.direction > 0 ? "more" : "less",
                 .evidence = alarm.evidence,
                 .since = drift.month_name(alarm.since),
                 .since_earliest = drift.month_name(alarm.since_earliest),
                 .since_latest = drift.month_name(alarm.since_latest),
                 .forecasts_are_true = alarm.is_calibrated,
                 .causes = {},
                 .explained_until = drift.month_name(explained.explained_until),
                 .consequence = explained.consequence,
                 .sentence = explained_sentence(drift, explained)};
  if (alarm.days) {
    row.days =
        AlarmedDays{metering::to_string(alarm.days->raised), metering::to_string(alarm.days->since),
                    metering::to_string(alarm.days->since_earliest),
                    metering::to_string(alarm.days->since_latest), alarm.days->excess};
  }
  for (const drift::Cause& cause : explained.causes) {
    row.causes.push_back({.kind = cause.kind,
                          .subject = subject_of(drift, cause),
                          .probability = cause.probability,
                          .log_evidence = cause.log_evidence,
                          .mean = cause.mean,
                          .q05 = cause.q05,
                          .q95 = cause.q95,
                          .words = cause_words(drift, cause)});
  }
  return row;
}

/// The newest month of an output, and how near the watches of its months and days are to an alarm.
OutputDrift newest_of(const drift::SiteDrift& drift, std::size_t k) {
  const drift::FollowedOutput& output = drift.outputs[k];
  OutputDrift newest{.output = output.name,
                     .month = "",
                     .log_evidence = output.state.log_evidence,
                     .log_threshold = output.state.log_threshold,
                     .change_within_year = output.state.change_within_year};
  if (output.daily) {
    newest.daily = DailyEvidence{output.daily->log_evidence, output.daily->log_threshold,
                                 output.daily->lag_one, output.daily->month_factor};
  }
  for (const drift::PrequentialMonth& month : drift.record) {
    if (!month.outputs[k]) continue;
    const double pit = month.outputs[k]->surprise.pit;
    newest.month = drift.month_name(month.month);
    newest.pvalue = 2.0 * std::min(pit, 1.0 - pit);
  }
  return newest;
}

}  // namespace

DriftSummary summary_of(const drift::SiteDrift& drift) {
  DriftSummary summary;
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    summary.outputs.push_back(newest_of(drift, k));
  }
  for (const drift::ExplainedAlarm& alarm : drift.alarms) {
    summary.alarms.push_back(alarm_of(drift, alarm));
  }
  for (const drift::MeterChange& change : drift.meter_changes) {
    summary.changed_meters.push_back({.meter = change.meter,
                                      .kind = change.kind,
                                      .since = change.since,
                                      .seen = change.seen,
                                      .factor = change.factor,
                                      .sentence = change.sentence});
  }
  return summary;
}

}  // namespace recald::views
