/// Time stamps as exports write them, and the instants that local clock times stand for.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::table {

/// The order of a date's parts, or the unit that is counted instead. Parts may be separated by - /
/// . or spaces, a month may be a name, a year may have two digits.
enum class TimeFormat : std::uint8_t {
  year_first,   ///< 2024-03-31 14:15, 2024-03-31T14:15:00+02:00, 20240331 1415
  day_first,    ///< 31/03/2024 14:15, 31.3.24 2:15 PM, 31-Mar-2024
  month_first,  ///< 03/31/2024 14:15, Mar 31, 2024
  excel,        ///< Days since the end of 1899, as spreadsheets count them.
  unix,         ///< Seconds, or ms, µs or ns by their size, since 1970 in UTC.
};

inline constexpr std::array<std::string_view, 5> kTimeFormats{"yyyy-mm-dd", "dd/mm/yyyy",
                                                              "mm/dd/yyyy", "excel", "unix"};
[[nodiscard]] inline std::string_view to_string(TimeFormat format) {
  return kTimeFormats[static_cast<std::size_t>(format)];
}

/// The content of a stamp: a time on some clock, and possibly the clock's offset.
struct WrittenTime {
  metering::Instant clock;  ///< As if the clock showed UTC.
  std::optional<std::chrono::seconds> utc_offset;
  bool has_time = true;        ///< False: only a date.
  bool is_range = false;       ///< It was "from – to"; the time is the first.
  bool is_zone_named = false;  ///< The offset is that of letters such as EST.
};

/// Besides what the formats show, there may be: a day of the week in front; months and days in the
/// languages of `words.hpp`; blanks of any width and marks that are not seen; "a. m."; "14h15";
/// letters of a zone, "EDT" or "MESZ", whose offset counts; "from – to" with a dash, a slash or a
/// word between, of which the first stamp counts. "2025-09-01 00:00-01:00" is a stamp with an
/// offset; behind dates that are not written year first such an end is the end of a range.
/// @return the time, or malformed, whose message names letters that are no known zone, or the order
///         of parts that would do; out_of_range outside the known years.
[[nodiscard]] Result<WrittenTime> parse_stamp(std::string_view text, TimeFormat format);

/// Whether `parse_stamp` would have a time.
[[nodiscard]] bool is_stamp(std::string_view text, TimeFormat format);

/// A time of day on its own.
struct WrittenClock {
  std::chrono::seconds time;
  std::optional<std::chrono::seconds> utc_offset;
  bool is_range = false;       ///< "00:00 - 00:15".
  bool is_zone_named = false;  ///< As in `WrittenTime`.
  bool is_hour = false;        ///< Only an hour, "7", or "7 - 8".
};
[[nodiscard]] std::optional<WrittenClock> parse_clock(std::string_view text);

/// "14:15", "2:15:00 PM", "24:00", "00:00 - 00:15"; no hour alone, nothing with an offset.
[[nodiscard]] std::optional<std::chrono::seconds> parse_time_of_day(std::string_view text);

/// Whether a header says that its times stay on winter time: "standard time", "Winterzeit".
[[nodiscard]] bool says_winter_time(std::string_view header);

/// The offset that a header says its times have: 0 of "timestamp_utc", an hour of "Zeit (UTC+1)".
[[nodiscard]] std::optional<std::chrono::seconds> offset_said(std::string_view header);

/// Converts successive times of one clock to instants. If the clock shows an hour twice, order
/// tells the two apart: once its times start again, it is the later hour.
class ClockReader {
 public:
  /// @param calendar  Outlives this.
  explicit ClockReader(const metering::LocalCalendar& calendar) : calendar_{&calendar} {}

  /// Of a time, where the clock changes.
  enum class Hour : std::uint8_t { usual, skipped, first, second };

  /// @return nothing for a time that the clock skips.
  [[nodiscard]] std::optional<metering::Instant> instant_of(metering::Instant clock);

  /// Of the last time that was converted.
  [[nodiscard]] Hour hour() const { return hour_; }

  /// Whether the last time is less than an hour before the one before it, or that time again, some
  /// seconds later if stamps lie beside the grid: as where a clock is put back.
  [[nodiscard]] bool came_again() const { return came_again_; }

  /// An interval's end where the clock changes may be written as the time of its begin plus its
  /// length: 02:00 where the clock goes from there to 03:00; 03:00 before 02:15 where it goes back.
  /// What the same clock shows next decides.
  struct EndAtChange {
    metering::Instant clock;
    metering::Instant instant;  ///< If it is written so.
    std::chrono::seconds jump;  ///< Forward; negative: back.

    [[nodiscard]] bool is_followed_by(metering::Instant next) const {
      return jump.count() > 0 ? next > clock + jump : next <= clock;
    }
  };
  [[nodiscard]] std::optional<EndAtChange> end_at_change(metering::Instant clock) const;

  /// Whether a time is the end of an interval within the hour that the clock skips, if its zone's
  /// changes are not the clock's: 02:15 to 03:00 where it goes from 02:00 to 03:00.
  [[nodiscard]] bool ends_in_skipped_hour(metering::Instant clock) const;

  /// Takes the time of `end` as the next.
  void pass(const EndAtChange& end);

 private:
  [[nodiscard]] std::optional<metering::Instant> with(metering::Instant clock,
                                                      std::chrono::seconds offset) const;

  /// Whether a time so much later is that before it again.
  [[nodiscard]] bool is_beside(std::chrono::seconds later) const;

  /// Of a time some seconds beside the full minutes at which a clock is changed: 01:59:59, which is
  /// skipped, for 02:00, or comes again as 01:00 does. @return nothing: it is none
  [[nodiscard]] std::optional<metering::Instant> beside_change(
      metering::Instant clock, std::optional<metering::Instant> last);

  const metering::LocalCalendar* calendar_;
  std::optional<metering::Instant> last_clock_;
  std::chrono::seconds step_{0};  ///< Between the two times before.
  bool was_again_ = false;        ///< The time before was that before it, or some seconds later.
  bool came_again_ = false;
  bool in_second_pass_ = false;
  Hour hour_ = Hour::usual;
};

}  // namespace recald::table
