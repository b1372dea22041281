#include "adapters/table/cells/stamps.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/loose_stamp.hpp"
#include "adapters/table/cells/stamp_parts.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using std::chrono::days;
using std::chrono::seconds;

Error no_stamp(std::string_view text, TimeFormat format) {
  return {ErrorCode::malformed,
          "timestamp " + csv::in_quotes(text) + " is not " + std::string{to_string(format)}};
}

/// Names the order of parts in which the text would be a time.
void add_nearest_format(std::string& message, std::string_view text, TimeFormat format) {
  for (const TimeFormat other :
       {TimeFormat::year_first, TimeFormat::day_first, TimeFormat::month_first}) {
    if (other == format || !parse_loosely(text, other).time) continue;
    message += "; it would be one as " + std::string{to_string(other)};
    return;
  }
}

Result<WrittenTime> in_range(const WrittenTime& time, std::string_view text) {
  if (time.clock < Instant{} + days{367} || time.clock >= metering::kLatestInstant - days{1}) {
    return failure(ErrorCode::out_of_range, "timestamp " + csv::in_quotes(text) + " lies outside " +
                                                std::string{metering::kKnownYears});
  }
  return time;
}

/// Seconds, or thousandths, millionths or milliardths of them, by the size of the count.
double unix_seconds(double count) {
  constexpr double kFirst_ms = 1e11;  // read as seconds, this would be the year 5138
  for (const double unit : {1e9, 1e6, 1e3}) {
    if (count >= kFirst_ms * unit / 1e3) return count / unit;
  }
  return count;
}

Result<WrittenTime> parse_count(std::string_view text, TimeFormat format) {
  std::string dotted{text};
  std::replace(dotted.begin(), dotted.end(), ',', '.');
  const auto count = csv::parse_number(dotted);
  if (!count) return tl::unexpected(no_stamp(text, format));
  if (format == TimeFormat::excel) {
    constexpr double kEpoch_days = 25'569.0;  // of 1970-01-01
    if (*count < kEpoch_days || *count > 80'000.0) {
      return failure(ErrorCode::out_of_range, "timestamp " + csv::in_quotes(text) +
                                                  " is no spreadsheet day of " +
                                                  std::string{metering::kKnownYears});
    }
    const auto since = static_cast<std::int64_t>(std::llround((*count - kEpoch_days) * 86'400.0));
    return in_range({.clock = Instant{seconds{since}}}, text);
  }
  const double whole_s = unix_seconds(*count);
  if (whole_s < 0.0 || whole_s > 5e9) {
    return failure(ErrorCode::out_of_range, "timestamp " + csv::in_quotes(text) + " lies outside " +
                                                std::string{metering::kKnownYears});
  }
  return in_range(
      {.clock = Instant{seconds{static_cast<std::int64_t>(whole_s)}}, .utc_offset = seconds{0}},
      text);
}

/// "Z", "+01:00", "-0800", "UTC", or nothing, up to the end.
bool take_offset(Scanner& scan, WrittenTime& written) {
  scan.skip(" ");
  if (scan.is_done()) return true;
  const std::string_view rest = scan.rest();
  if (rest == "Z" || rest == "z" || rest == "UTC" || rest == "GMT") {
    written.utc_offset = seconds{0};
    return true;
  }
  written.utc_offset = take_numeric_offset(scan, 2);
  return written.utc_offset.has_value() && scan.is_done();
}

/// As nearly all stamps are written, and without a copy. @return nothing for what takes more care
std::optional<WrittenTime> parse_plainly(std::string_view text, TimeFormat format) {
  Scanner scan{text};
  const auto date = take_date(scan, format);
  if (!date) return {};
  WrittenTime written{.clock = Instant{*date}};
  const std::string_view between = scan.rest();
  scan.skip(" ,T");
  if (scan.is_done()) {
    written.has_time = false;
    return written;
  }
  const bool is_iso = !between.empty() && between.front() == 'T';
  const auto time = take_time(scan);
  if (!time || (!is_iso && is_at_end_of_range(scan.rest(), format))) return {};
  if (!take_offset(scan, written)) return {};
  written.clock += *time;
  return written;
}

}  // namespace

Result<WrittenTime> parse_stamp(std::string_view text, TimeFormat format) {
  if (format == TimeFormat::excel || format == TimeFormat::unix) return parse_count(text, format);
  if (const auto plain = parse_plainly(text, format)) return in_range(*plain, text);
  if (!is_utf8(text)) return parse_stamp(utf8_of(text), format);  // dashes of Windows
  LooseStamp loose = parse_loosely(text, format);
  if (loose.time) return in_range(*loose.time, text);
  Error error = no_stamp(text, format);
  if (!loose.odd_end.empty()) {
    error.message += "; it ends in " + csv::in_quotes(loose.odd_end) +
                     ", which is no time zone that recald knows; an offset such as +01:00 is clear";
  } else {
    add_nearest_format(error.message, text, format);
  }
  return tl::unexpected(std::move(error));
}

bool is_stamp(std::string_view text, TimeFormat format) {
  if (format == TimeFormat::excel || format == TimeFormat::unix) {
    return parse_count(text, format).has_value();
  }
  auto time = parse_plainly(text, format);
  if (!time && !is_utf8(text)) return is_stamp(utf8_of(text), format);
  if (!time) time = parse_loosely(text, format).time;
  return time && in_range(*time, text).has_value();
}

std::optional<WrittenClock> parse_clock(std::string_view text) {
  Scanner scan{text};
  const auto time = take_time(scan);
  if (time && scan.is_done()) return WrittenClock{*time, {}};
  return is_utf8(text) ? parse_clock_loosely(text) : parse_clock_loosely(utf8_of(text));
}

std::optional<seconds> parse_time_of_day(std::string_view text) {
  const auto clock = parse_clock(text);
  if (!clock || clock->utc_offset || clock->is_hour) return {};
  return clock->time;
}

std::optional<Instant> ClockReader::with(Instant clock, seconds offset) const {
  const Instant t = clock - offset;
  return calendar_->utc_offset(t) == offset ? std::optional{t} : std::nullopt;
}

std::optional<Instant> ClockReader::instant_of(Instant clock) {
  const std::optional<Instant> last = last_clock_;
  last_clock_ = clock;
  const bool is_again = last && clock >= *last && is_beside(clock - *last);
  if (last && clock > *last && !is_again) step_ = clock - *last;
  was_again_ = is_again;
  came_again_ = is_again || (last && clock < *last && *last - clock < std::chrono::hours{1});
  // No zone changes twice within two days, so the offsets a day before and a day after
  // are the only ones.
  const auto before = with(clock, calendar_->utc_offset(clock - days{1}));
  const auto after = with(clock, calendar_->utc_offset(clock + days{1}));
  if (!before || !after || *before == *after) {
    const auto beside = beside_change(clock, last);
    hour_ = before || after || beside ? Hour::usual : Hour::skipped;
    if (beside) return beside;
    in_second_pass_ = false;
    return before ? before : after;
  }
  const Instant first = std::min(*before, *after);
  const Instant second = std::max(*before, *after);
  if (last && clock < *last) in_second_pass_ = true;
  // If a file is sorted by the written stamp, both occurrences of a time are neighbours, some
  // seconds apart if its stamps lie beside the grid.
  const bool is_second = in_second_pass_ || is_again;
  hour_ = is_second ? Hour::second : Hour::first;
  return is_second ? second : first;
}

bool ClockReader::is_beside(seconds later) const {
  constexpr int kBesideShare = 10;  // of a step
  constexpr seconds kBesideMax{60};
  return later == seconds{0} ||
         (!was_again_ && later <= kBesideMax && kBesideShare * later <= step_);
}

std::optional<Instant> ClockReader::beside_change(Instant clock, std::optional<Instant> last) {
  constexpr seconds kGrid{300};
  constexpr seconds kBeside{60};
  const Instant grid = metering::interval_start(clock + kBeside, kGrid);
  if (grid == clock || clock > grid + kBeside) return {};
  const auto before = with(grid, calendar_->utc_offset(grid - days{1}));
  const auto after = with(grid, calendar_->utc_offset(grid + days{1}));
  const auto shifted = [&](Instant t) { return t - (grid - clock); };
  const bool is_skipped = !with(clock, calendar_->utc_offset(clock - days{1})) &&
                          !with(clock, calendar_->utc_offset(clock + days{1}));
  if (is_skipped)
    return before || after ? std::optional{shifted(before ? *before : *after)} : std::nullopt;
  const bool is_back = last && clock <= *last;
  if (!is_back || !before || !after || *before == *after) return {};
  in_second_pass_ = true;
  return shifted(std::max(*before, *after));
}

std::optional<ClockReader::EndAtChange> ClockReader::end_at_change(Instant clock) const {
  constexpr seconds kHalfHour{1800};  // no clock is changed at another time
  if (clock.time_since_epoch() % kHalfHour != seconds{0}) return {};
  const seconds before = calendar_->utc_offset(clock - days{1});
  const seconds after = calendar_->utc_offset(clock + days{1});
  if (before == after) return {};
  const EndAtChange end{clock, clock - before, after - before};
  const bool is_old = with(clock, before).has_value();
  const bool is_new = with(clock, after).has_value();
  if (!with(clock - seconds{1}, before) || is_old) return {};
  if (end.jump.count() > 0) return is_new ? std::nullopt : std::optional{end};
  return in_second_pass_ ? std::nullopt : std::optional{end};
}

bool ClockReader::ends_in_skipped_hour(Instant clock) const {
  const Instant within = clock - seconds{1};
  return !with(within, calendar_->utc_offset(clock - days{1})) &&
         !with(within, calendar_->utc_offset(clock + days{1}));
}

void ClockReader::pass(const EndAtChange& end) {
  last_clock_ = end.clock;
  in_second_pass_ = end.jump.count() < 0;
  was_again_ = came_again_ = false;
  hour_ = Hour::usual;
}

}  // namespace recald::table
