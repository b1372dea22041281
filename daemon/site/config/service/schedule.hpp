/// When work repeats: at once when a month closes, at times of the local calendar, or never.
#pragma once

#include <bitset>
#include <optional>
#include <string_view>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::daemon {

/// Times of the local calendar as a crontab writes them. A time that the clock jumps over comes at
/// the jump; one that occurs twice, at the first.
struct CalendarTimes {
  std::bitset<60> minutes;
  std::bitset<24> hours;
  std::bitset<32> days;     ///< 1…31
  std::bitset<13> months;   ///< 1…12
  std::bitset<7> weekdays;  ///< 0 is Sunday.
  bool any_day = true;      ///< The day field is "*".
  bool any_weekday = true;  ///< Where both are given, a day that fits either counts.

  /// The first such time after `t`, within four years; none where there is none: 30 February.
  [[nodiscard]] std::optional<metering::Instant> next(
      metering::Instant t, const metering::LocalCalendar& calendar) const;
};

struct Schedule {
  bool when_a_month_closes = false;
  std::optional<CalendarTimes> times;

  [[nodiscard]] bool is_never() const { return !when_a_month_closes && !times; }
};

/// "monthly" (when a month closes), "never", or five fields "minute hour day month weekday" with
/// numbers, `*`, lists "1,15", ranges "1-5" and steps "*/10".
/// @return or malformed with the field that is wrong.
[[nodiscard]] Result<Schedule> parse_schedule(std::string_view text);

}  // namespace recald::daemon
