/// Converts between instants and local calendars: months, days and schedule hours of one time zone.
///
/// Everything inside recald is UTC; local time is used only for months, days, schedules and people.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace date {
class time_zone;
}

namespace recald::metering {

using Instant = std::chrono::sys_seconds;  ///< UTC, whole seconds.
using Month = std::chrono::year_month;     ///< A local calendar month.
using Day = std::chrono::year_month_day;   ///< A local calendar day.

inline constexpr std::chrono::seconds kDay{86'400};  ///< 24 hours, as most days have.

[[nodiscard]] inline double in_hours(std::chrono::seconds span) {
  return static_cast<double>(span.count()) / 3600.0;
}

/// The start of the interval that contains t, on a grid of whole multiples since 1970. @pre t
/// is not before 1970
[[nodiscard]] inline Instant interval_start(Instant t, std::chrono::seconds interval) {
  return t - t.time_since_epoch() % interval;
}

/// Half open: [begin, end).
struct TimeSpan {
  Instant begin;
  Instant end;

  [[nodiscard]] std::chrono::seconds length() const { return end - begin; }
  [[nodiscard]] bool contains(Instant t) const { return begin <= t && t < end; }
  bool operator==(const TimeSpan&) const = default;
};

/// An instant in local wall-clock time.
struct LocalTime {
  Day date;
  int minute_of_day;  ///< 0…1439, as on the wall clock.
};

/// The years that recald knows: what lies outside is a mistake. A counter of seconds that is full
/// at 32 bits says 2106, one that was never set 1970.
inline constexpr std::chrono::year kFirstKnownYear{1971};
inline constexpr std::chrono::year kLastKnownYear{2100};
inline constexpr std::string_view kKnownYears = "1971 to 2100";
/// First instant that recald refuses.
inline constexpr Instant kLatestInstant =
    std::chrono::sys_days{(kLastKnownYear + std::chrono::years{1}) / std::chrono::January / 1};

/// Offset of local time from UTC, constant on [span.begin, span.end).
struct OffsetSpan {
  TimeSpan span;
  std::chrono::seconds utc_offset;  ///< Local minus UTC.
};

/// The calendar of one IANA time zone. After the last change that the zone's file lists, the rule
/// at the file's end goes on. Cheap to copy; lookups do not allocate after `open`.
class LocalCalendar {
 public:
  /// @return the calendar, or not_found if the system's zone files lack `zone_name`.
  static Result<LocalCalendar> open(std::string_view zone_name);

  /// [first instant of day 1, first instant of the next month's day 1).
  /// A midnight that does not exist starts at the first existing instant, a repeated one at its
  /// first occurrence. @pre the month lies in the known years.
  [[nodiscard]] TimeSpan month_span(Month month) const;
  [[nodiscard]] TimeSpan day_span(Day day) const;

  [[nodiscard]] LocalTime local_time(Instant t) const;
  [[nodiscard]] Month month_of(Instant t) const;
  [[nodiscard]] std::chrono::seconds utc_offset(Instant t) const;
  /// Of the year's standard time: the lesser offset of its two opposite seasons is winter's, in
  /// either hemisphere.
  [[nodiscard]] std::chrono::seconds standard_offset(std::chrono::year year) const;

  /// The first instant that shows this wall-clock time, or the jump if the clock skips it.
  [[nodiscard]] Instant first_instant(Day day, int minute_of_day) const;

  [[nodiscard]] const std::string& zone_name() const { return zone_name_; }

 private:
  LocalCalendar() = default;
  [[nodiscard]] const OffsetSpan& offset_span(Instant t) const;

  std::string zone_name_;
  std::vector<OffsetSpan> offsets_;  ///< Ordered and without gaps from 1970 to `kLatestInstant`.
};

/// Days of the month, 28…31.
[[nodiscard]] int days_in(Month month);

/// The month after, the month before; `months_between(a, b)` is b − a in months.
[[nodiscard]] Month next_month(Month month);
[[nodiscard]] Month previous_month(Month month);
[[nodiscard]] int months_between(Month from, Month to);

/// "2016-03", "2016-03-01", "2016-03-01T05:00:00Z".
[[nodiscard]] std::string to_string(Month month);
[[nodiscard]] std::string to_string(Day day);
[[nodiscard]] std::string to_string(Instant t);

/// Accepts exactly "YYYY-MM" or "YYYY-MM-DD"; anything else is malformed.
[[nodiscard]] Result<Month> parse_month(std::string_view text);
[[nodiscard]] Result<Day> parse_day(std::string_view text);

}  // namespace recald::metering
