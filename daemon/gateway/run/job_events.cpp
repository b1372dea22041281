#include "daemon/gateway/run/job_events.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace recald::daemon {
namespace {

/// Months shift the start of a change a little as they come in.
bool is_same_change(const DriftAlarm& now, const DriftAlarm& then) {
  return now.output == then.output && now.since >= then.since_earliest &&
         now.since <= then.since_latest;
}

bool is_new(const DriftAlarm& alarm, const std::optional<StoredJob>& before) {
  if (!before || !before->result.drift) return true;
  return std::ranges::none_of(before->result.drift->alarms,
                              [&](const DriftAlarm& then) { return is_same_change(alarm, then); });
}

bool is_new(const ChangedMeter& changed, const std::optional<StoredJob>& before) {
  if (!before || !before->result.drift) return true;
  return std::ranges::none_of(before->result.drift->changed_meters, [&](const ChangedMeter& then) {
    return then.meter == changed.meter && then.kind == changed.kind;
  });
}

}  // namespace

std::vector<StoreEvent> events_of(const StoredJob& job, bool has_named,
                                  const std::optional<StoredJob>& before) {
  std::vector<StoreEvent> events;
  const auto add = [&](Severity severity, std::string kind, std::string text) {
    events.push_back({.time = job.ended.value_or(job.asked),
                      .severity = severity,
                      .kind = std::move(kind),
                      .subject = "",
                      .text = std::move(text)});
  };
  const std::string name = fmt::format("{} {}", name_of(job.kind), job.number);
  if (job.state == JobState::failed) {
    add(Severity::warning, fmt::format("{}_failed", name_of(job.kind)),
        fmt::format("{} failed: {}", name, job.message));
  }
  if (job.state != JobState::done) return events;
  if (!job.accepted) {
    add(Severity::warning, "calibration_rejected",
        fmt::format("{} was not accepted: {}", name, job.message));
  }
  if (has_named) add(Severity::info, "cause_named", fmt::format("{} {}", name, job.message));
  if (job.accepted && job.result.drift) {
    for (const DriftAlarm& alarm : job.result.drift->alarms) {
      if (!is_new(alarm, before)) continue;
      add(Severity::warning, "drift_alarm", alarm.sentence);
      events.back().subject = alarm.output;
    }
    for (const ChangedMeter& changed : job.result.drift->changed_meters) {
      if (!is_new(changed, before)) continue;
      add(Severity::warning, "drift_alarm", changed.sentence);
      events.back().subject = changed.meter;
    }
  }
  return events;
}

}  // namespace recald::daemon
