#include "daemon/site/setup/clock_evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "daemon/site/replay/clock_doubts.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::seconds;

/// Days on which the clock is put forward.
int spring_changes(const metering::TimeSpan& span, const metering::LocalCalendar& calendar) {
  int changes = 0;
  constexpr std::chrono::hours kStep{12};
  for (Instant t = span.begin; t + kStep <= span.end; t += kStep) {
    if (calendar.utc_offset(t + kStep) > calendar.utc_offset(t)) ++changes;
  }
  return changes;
}

struct ChangeDays {
  metering::Day spring;
  metering::Day autumn;
};

std::optional<ChangeDays> days_of_fixed_clock(
    const table::ClockFacts& facts, const metering::TimeSpan& span, double per_hour,
    const metering::LocalCalendar& calendar,
    table::ClockChange::Counts table::ClockChange::*counts_of) {
  constexpr double kMost = 0.75;  // of an hour's stamps
  int springs = 0;
  std::optional<metering::Day> spring;
  std::optional<metering::Day> autumn;
  if (!facts.put_back.empty() && other_clock(facts, calendar)) return {};
  for (const auto& [day, change] : facts.changes) {
    if (change.rows.second > 0 || facts.put_back.contains(day)) return {};
    const table::ClockChange::Counts& counts = change.*counts_of;
    // Whether times are starts or ends: of the hour that is skipped, its rows have what they say.
    const auto skipped = std::min(counts.skipped, counts.skipped_ends);
    if (static_cast<double>(skipped) >= kMost * per_hour) {
      ++springs;
      spring = day;
    }
    if (static_cast<double>(counts.first) >= kMost * per_hour) autumn = day;
  }
  if (!spring || !autumn || springs < spring_changes(span, calendar)) return {};
  return ChangeDays{*spring, *autumn};
}

}  // namespace

std::optional<std::string> zone_of_offset(seconds offset) {
  if (offset % std::chrono::hours{1} != seconds{0}) return {};
  const auto hours = std::chrono::duration_cast<std::chrono::hours>(offset).count();
  // Etc/GMT-1 is one hour ahead of UTC: POSIX counts westwards.
  return hours == 0 ? "Etc/GMT"
                    : fmt::format("Etc/GMT{}{}", hours > 0 ? '-' : '+', std::abs(hours));
}

std::optional<std::string> fixed_zone(const metering::LocalCalendar& calendar, Instant around) {
  const auto year = std::chrono::year_month_day{std::chrono::floor<std::chrono::days>(around)};
  return zone_of_offset(calendar.standard_offset(year.year()));
}

std::optional<std::string> fixed_clock_because(const table::ClockFacts& facts,
                                               const metering::TimeSpan& span, double per_hour,
                                               const metering::LocalCalendar& calendar) {
  const auto days =
      days_of_fixed_clock(facts, span, per_hour, calendar, &table::ClockChange::values);
  if (!days) return {};
  return fmt::format(
      "it has values in the hour of {} that {} jumps over, and no hour twice on {}: its clock "
      "stays on winter time",
      metering::to_string(days->spring), calendar.zone_name(), metering::to_string(days->autumn));
}

std::optional<std::string> fixed_clock_by_rows(const table::ClockFacts& facts,
                                               const metering::TimeSpan& span, double per_hour,
                                               const metering::LocalCalendar& calendar) {
  const auto days = days_of_fixed_clock(facts, span, per_hour, calendar, &table::ClockChange::rows);
  if (!days) return {};
  return fmt::format("it has rows in the hour of {} that {} jumps over, and no hour twice on {}",
                     metering::to_string(days->spring), calendar.zone_name(),
                     metering::to_string(days->autumn));
}

std::optional<OpenQuestion> winter_time_question(const std::filesystem::path& file,
                                                 const table::ClockFacts& facts,
                                                 const metering::TimeSpan& span, double per_hour,
                                                 const metering::LocalCalendar& calendar) {
  const auto because = fixed_clock_by_rows(facts, span, per_hour, calendar);
  const auto zone = fixed_zone(calendar, span.begin);
  if (!because || !zone) return {};
  return OpenQuestion{
      .words = fmt::format("'{}': {}, but these rows have no value or zero; its clock may stay on "
                           "winter time.",
                           file.string(), *because),
      .option = "--clock",
      .subject = "",
      .answers = {*zone, calendar.zone_name()}};
}

}  // namespace recald::daemon
