#include "core/drift/watch/daily_watches.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace recald::drift {
namespace {

constexpr double kDaysAMonth = 365.25 / 12.0;
constexpr std::chrono::days kSameChange{31};
/// Of a meter that has not noticed the change itself.
constexpr double kLevelSd = 0.1;

}  // namespace

DailyWatches::DailyWatches(std::vector<Output> outputs, std::vector<std::string> months,
                           int learning_months, double months_between_false_alarms)
    : months_(std::move(months)) {
  DailyWatchOptions options;
  options.days_between_false_alarms =
      months_between_false_alarms * kDaysAMonth * static_cast<double>(outputs.size());
  for (Output& one : outputs) {
    DailyWatch watch{std::move(one.days), learning_months, options};
    if (watch.is_able()) watched_.push_back({one.output, std::move(watch)});
  }
}

bool DailyWatches::is_able() const { return !watched_.empty(); }

std::vector<Alarm> DailyWatches::evaluate(int month) {
  std::vector<Alarm> alarms;
  for (Watched& watched : watched_) {
    const auto alarm = watched.watch.evaluate(month);
    if (!alarm) continue;
    watched.begun = alarm->since;
    alarms.push_back(alarm_of(watched, *alarm));
  }
  return alarms;
}

Alarm DailyWatches::alarm_of(const Watched& watched, const DailyAlarm& alarm) const {
  return {.month = alarm.month,
          .output = watched.output,
          .direction = alarm.direction,
          .evidence = alarm.evidence,
          .since = month_of_change(alarm.since, alarm.month),
          .since_earliest = month_of_change(alarm.since_earliest, alarm.month),
          .since_latest = month_of_change(alarm.since_latest, alarm.month),
          .is_calibrated = true,
          .days = AlarmDays{.raised = alarm.raised,
                            .since = alarm.since,
                            .since_earliest = alarm.since_earliest,
                            .since_latest = alarm.since_latest,
                            .excess = alarm.excess}};
}

/// The first month that is mostly after the day.
int DailyWatches::month_of_change(metering::Day day, int latest) const {
  const metering::Month month{day.year(), day.month()};
  const bool is_early = static_cast<unsigned>(day.day()) <= 15;
  const auto first = metering::to_string(is_early ? month : month + std::chrono::months{1});
  const auto found = std::ranges::lower_bound(months_, first);
  return std::min(static_cast<int>(found - months_.begin()), latest);
}

void DailyWatches::begin_at(int month) {
  const auto first = metering::parse_month(months_[static_cast<std::size_t>(month)]).value();
  const std::chrono::sys_days since{first / 1};
  for (Watched& watched : watched_) {
    if (watched.begun && std::chrono::sys_days{*watched.begun} + kSameChange >= since) continue;
    watched.begun = metering::Day{since};
    watched.watch.begin_at(*watched.begun, kLevelSd);
  }
}

void DailyWatches::set_aside(int output) {
  std::erase_if(watched_, [&](const Watched& watched) { return watched.output == output; });
}

std::optional<DailyState> DailyWatches::state(int output) const {
  const auto found = std::ranges::find(watched_, output, &Watched::output);
  if (found == watched_.end()) return std::nullopt;
  return DailyState{.log_evidence = found->watch.log_evidence(),
                    .log_threshold = found->watch.log_threshold(),
                    .lag_one = found->watch.lag_one(),
                    .month_factor = found->watch.month_factor()};
}

}  // namespace recald::drift
