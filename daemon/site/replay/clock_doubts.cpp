#include "daemon/site/replay/clock_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::seconds;

/// One zone for each way of changing clocks, and the largest of those that change alike.
constexpr std::array<std::string_view, 14> kZones{
    "America/New_York", "America/Chicago",    "America/Denver",   "America/Los_Angeles",
    "Europe/London",    "Europe/Berlin",      "Europe/Helsinki",  "Atlantic/Azores",
    "Australia/Sydney", "Australia/Adelaide", "Pacific/Auckland", "America/Santiago",
    "America/Asuncion", "Asia/Jerusalem"};

/// Whether the zone's clock shows this time twice on its day. Labels of an interval's end may be
/// the end of that hour.
bool shows_twice(const metering::LocalCalendar& calendar, metering::Day day, Instant shown) {
  const metering::TimeSpan span = calendar.day_span(day);
  if (span.length() <= std::chrono::hours{24}) return false;
  const seconds before = calendar.utc_offset(span.begin);
  constexpr seconds kStep{900};
  for (Instant t = span.begin; t < span.end; t += kStep) {
    const seconds now = calendar.utc_offset(t);
    if (now >= before) continue;
    constexpr seconds kBeside{120};  // stamps of loggers that are early or late
    return shown + kBeside >= t + now && shown <= t + before + kBeside;
  }
  return false;
}

bool explains_all(const table::ClockFacts& facts, const metering::LocalCalendar& calendar) {
  return std::ranges::all_of(facts.put_back, [&](const auto& one) {
    return shows_twice(calendar, one.first, one.second);
  });
}

}  // namespace

std::optional<OtherClock> other_clock(const table::ClockFacts& facts,
                                      const metering::LocalCalendar& calendar) {
  const bool are_few = facts.put_back.size() < table::ClockFacts::kPutBackMax;
  if (facts.put_back.empty() || !are_few || explains_all(facts, calendar)) return {};
  OtherClock other;
  for (const std::string_view name : kZones) {
    const auto zone = metering::LocalCalendar::open(std::string{name});
    if (zone && explains_all(facts, *zone)) other.zones.emplace_back(name);
  }
  if (other.zones.empty()) return {};
  const auto odd = std::ranges::find_if(facts.put_back, [&](const auto& one) {
    return !shows_twice(calendar, one.first, one.second);
  });
  const auto minute = std::chrono::duration_cast<std::chrono::minutes>(
      odd->second - std::chrono::floor<std::chrono::days>(odd->second));
  other.because = fmt::format("on {} its clock shows {:02}:{:02} twice, which that of {} does not",
                              metering::to_string(odd->first), minute.count() / 60,
                              minute.count() % 60, calendar.zone_name());
  return other;
}

}  // namespace recald::daemon
