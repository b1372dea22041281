#include "adapters/table/stamps.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "adapters/csv/fields.hpp"
#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::seconds;

bool is_figure(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// Reads a text from its front.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_{text} {}

  [[nodiscard]] bool is_done() const { return text_.empty(); }
  [[nodiscard]] char front() const { return text_.empty() ? '\0' : text_.front(); }
  [[nodiscard]] std::string_view rest() const { return text_; }

  bool take(char c) {
    if (front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }

  void skip(std::string_view signs) {
    while (!text_.empty() && signs.find(text_.front()) != std::string_view::npos) {
      text_.remove_prefix(1);
    }
  }

  /// Up to `most` digits as a number, or nothing if there are none.
  std::optional<int> number(std::size_t most) {
    int value = 0;
    std::size_t count = 0;
    while (count < most && is_figure(front())) {
      value = 10 * value + (front() - '0');
      text_.remove_prefix(1);
      ++count;
    }
    if (count == 0) return {};
    digits_ = count;
    return value;
  }
  [[nodiscard]] std::size_t digits() const { return digits_; }  ///< In the last number read.

  /// The letters at the front.
  std::string_view word() {
    std::size_t count = 0;
    while (count < text_.size() && is_letter(text_[count])) ++count;
    const std::string_view word = text_.substr(0, count);
    text_.remove_prefix(count);
    return word;
  }

 private:
  std::string_view text_;
  std::size_t digits_ = 0;
};

/// 1…12, from the first three letters of the month's English name.
std::optional<int> month_of(std::string_view name) {
  constexpr std::string_view kNames = "janfebmaraprmayjunjulaugsepoctnovdec";
  if (name.size() < 3) return {};
  std::string start;
  for (const char c : name.substr(0, 3)) {
    start += to_lower(c);
  }
  const std::size_t at = kNames.find(start);
  if (at == std::string_view::npos || at % 3 != 0) return {};
  return static_cast<int>(at / 3) + 1;
}

constexpr std::string_view kDateSigns = "-/. ,";

std::optional<int> take_month(Scanner& scan) {
  if (is_letter(scan.front())) return month_of(scan.word());
  return scan.number(2);
}

std::optional<int> take_year(Scanner& scan) {
  const auto year = scan.number(4);
  if (!year || (scan.digits() != 4 && scan.digits() != 2)) return {};
  if (scan.digits() == 4) return year;
  return *year + (*year < 70 ? 2000 : 1900);
}

struct Date {
  std::optional<int> year;
  std::optional<int> month;
  std::optional<int> day;
};

Date take_date(Scanner& scan, TimeFormat format) {
  Date date;
  const auto apart = [&] { scan.skip(kDateSigns); };
  if (format == TimeFormat::year_first) {
    date.year = take_year(scan);
    if (scan.digits() != 4) return {};
    apart();
    date.month = take_month(scan);
    apart();
    date.day = scan.number(2);
    return date;
  }
  if (format == TimeFormat::day_first) {
    date.day = scan.number(2);
    apart();
    date.month = take_month(scan);
  } else {
    date.month = take_month(scan);
    apart();
    date.day = scan.number(2);
  }
  apart();
  date.year = take_year(scan);
  return date;
}

/// "14:15:00.0", "2:15 PM", "1415". @return nothing for any other text
std::optional<seconds> take_time(Scanner& scan) {
  const auto hour = scan.number(2);
  if (!hour) return {};
  const bool has_colon = scan.take(':') || (scan.front() == '.' && scan.take('.'));
  if (!has_colon && !is_figure(scan.front())) return {};
  const auto minute = scan.number(2);
  if (!minute || scan.digits() != 2) return {};
  int second = 0;
  if (scan.take(':') || (!has_colon && is_figure(scan.front()))) {
    const auto given = scan.number(2);
    if (!given || scan.digits() != 2) return {};
    second = *given;
    if (scan.take('.') || scan.take(',')) scan.skip("0123456789");
  }
  int hour_of_day = *hour;
  Scanner after = scan;
  after.skip(" ");
  if (is_letter(after.front())) {
    std::string half;
    for (const char c : after.word()) {
      half += to_lower(c);
    }
    if (half == "am" || half == "pm") {
      if (hour_of_day < 1 || hour_of_day > 12) return {};
      hour_of_day = hour_of_day % 12 + (half == "pm" ? 12 : 0);
      scan = after;
    }
  }
  const bool is_end_of_day = hour_of_day == 24 && *minute == 0 && second == 0;
  if ((hour_of_day > 23 && !is_end_of_day) || *minute > 59 || second > 59) return {};
  return seconds{hour_of_day * 3600 + *minute * 60 + second};
}

/// "Z", "+01:00", "-0800", "UTC"
bool take_offset(Scanner& scan, std::optional<seconds>& offset) {
  scan.skip(" ");
  if (scan.is_done()) return true;
  const std::string_view rest = scan.rest();
  if (rest == "Z" || rest == "z" || rest == "UTC" || rest == "GMT") {
    offset = seconds{0};
    return true;
  }
  const bool is_west = scan.front() == '-';
  if (!scan.take('-') && !scan.take('+')) return false;
  const auto hour = scan.number(2);
  if (!hour || scan.digits() != 2 || *hour > 14) return false;
  int minute = 0;
  if (!scan.is_done()) {
    scan.take(':');
    const auto given = scan.number(2);
    if (!given || scan.digits() != 2 || *given > 59) return false;
    minute = *given;
  }
  if (!scan.is_done()) return false;
  const seconds east{*hour * 3600 + minute * 60};
  offset = is_west ? -east : east;
  return true;
}

Error no_stamp(std::string_view text, TimeFormat format) {
  return {ErrorCode::malformed,
          "timestamp " + csv::in_quotes(text) + " is not " + std::string{to_string(format)}};
}

Result<WrittenTime> in_range(const WrittenTime& time, std::string_view text) {
  if (time.clock < Instant{} + days{367} || time.clock >= metering::kLatestInstant - days{1}) {
    return failure(ErrorCode::out_of_range, "timestamp " + csv::in_quotes(text) + " lies outside " +
                                                std::string{metering::kKnownYears});
  }
  return time;
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
  constexpr double kFirstMilliseconds = 1e11;  // read as seconds, this would be the year 5138
  const double whole_s = *count >= kFirstMilliseconds ? *count / 1000.0 : *count;
  if (whole_s < 0.0 || whole_s > 5e9) {
    return failure(ErrorCode::out_of_range, "timestamp " + csv::in_quotes(text) + " lies outside " +
                                                std::string{metering::kKnownYears});
  }
  return in_range(
      {.clock = Instant{seconds{static_cast<std::int64_t>(whole_s)}}, .utc_offset = seconds{0}},
      text);
}

}  // namespace

Result<WrittenTime> parse_stamp(std::string_view text, TimeFormat format) {
  if (format == TimeFormat::excel || format == TimeFormat::unix) return parse_count(text, format);
  Scanner scan{text};
  const Date date = take_date(scan, format);
  if (!date.year || !date.month || !date.day) return tl::unexpected(no_stamp(text, format));
  const std::chrono::year_month_day day{std::chrono::year{*date.year},
                                        std::chrono::month{static_cast<unsigned>(*date.month)},
                                        std::chrono::day{static_cast<unsigned>(*date.day)}};
  if (!day.ok()) return tl::unexpected(no_stamp(text, format));
  WrittenTime written{.clock = Instant{std::chrono::sys_days{day}}};
  scan.skip(" ,T");
  if (scan.is_done()) {
    written.has_time = false;
    return in_range(written, text);
  }
  const auto time = take_time(scan);
  if (!time || !take_offset(scan, written.utc_offset)) {
    return tl::unexpected(no_stamp(text, format));
  }
  written.clock += *time;
  return in_range(written, text);
}

std::optional<seconds> parse_time_of_day(std::string_view text) {
  Scanner scan{text};
  const auto time = take_time(scan);
  return scan.is_done() ? time : std::nullopt;
}

std::optional<Instant> ClockReader::instant_of(Instant clock) {
  // No zone changes twice within two days, so the offsets a day before and a day after
  // are the only ones.
  const auto with = [&](seconds offset) -> std::optional<Instant> {
    const Instant t = clock - offset;
    return calendar_->utc_offset(t) == offset ? std::optional{t} : std::nullopt;
  };
  const std::optional<Instant> last = last_clock_;
  last_clock_ = clock;
  const auto before = with(calendar_->utc_offset(clock - days{1}));
  const auto after = with(calendar_->utc_offset(clock + days{1}));
  if (!before || !after || *before == *after) {
    in_second_pass_ = false;
    hour_ = before || after ? Hour::usual : Hour::skipped;
    return before ? before : after;
  }
  const Instant first = std::min(*before, *after);
  const Instant second = std::max(*before, *after);
  if (last && clock < *last) in_second_pass_ = true;
  // If a file is sorted by the written stamp, both occurrences of a time are neighbours.
  const bool is_second = in_second_pass_ || (last && clock == *last);
  hour_ = is_second ? Hour::second : Hour::first;
  return is_second ? second : first;
}

}  // namespace recald::table
