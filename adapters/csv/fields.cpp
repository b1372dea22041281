#include "adapters/csv/fields.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/text/printable.hpp"

namespace recald::csv {
namespace {

using metering::Instant;
using std::chrono::seconds;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The number in `count` digits from `at` on, or -1.
int digits(std::string_view text, std::size_t at, std::size_t count) {
  if (at + count > text.size()) return -1;
  int value = 0;
  for (std::size_t i = at; i < at + count; ++i) {
    if (!is_digit(text[i])) return -1;
    value = 10 * value + (text[i] - '0');
  }
  return value;
}

bool has(std::string_view text, std::size_t at, char c) {
  return at < text.size() && text[at] == c;
}

Error bad_stamp(std::string_view text, std::string_view what) {
  return {ErrorCode::malformed, "timestamp " + in_quotes(text) + " " + std::string{what}};
}

/// "Z", "+01:00", "-0800", "+05" as local time minus UTC; nothing if the text is neither.
std::optional<seconds> parse_offset(std::string_view text) {
  if (text == "Z" || text == "z") return seconds{0};
  if (text.empty() || (text[0] != '+' && text[0] != '-')) return {};
  const int hour = digits(text, 1, 2);
  const std::size_t minute_at = has(text, 3, ':') ? 4 : 3;
  const int minute = text.size() == 3 ? 0 : digits(text, minute_at, 2);
  const bool whole = text.size() == 3 || text.size() == minute_at + 2;
  if (hour < 0 || hour > 14 || minute < 0 || minute > 59 || !whole) return {};
  const seconds offset{hour * 3600 + minute * 60};
  return text[0] == '-' ? -offset : offset;
}

}  // namespace

std::size_t FieldSplitter::split(std::string_view line) {
  std::size_t count = 0;
  for (;;) {
    if (!line.empty() && line.front() == '"') return split_quoted(line);
    if (count == kFieldsMax) return kFieldsMax + 1;
    const auto* comma = line.empty()
                            ? nullptr
                            : static_cast<const char*>(std::memchr(line.data(), ',', line.size()));
    const std::size_t length =
        comma == nullptr ? line.size() : static_cast<std::size_t>(comma - line.data());
    fields_[count++] = line.substr(0, length);
    if (comma == nullptr) return count;
    line.remove_prefix(length + 1);
    if (!line.empty() && line.front() == '"') {
      const char* begin = fields_[0].data();
      return split_quoted({begin, static_cast<std::size_t>(line.data() + line.size() - begin)});
    }
  }
}

std::size_t FieldSplitter::split_quoted(std::string_view line) {
  // Contents are never longer than the line, so reserving once keeps earlier fields valid.
  unquoted_.clear();
  unquoted_.reserve(line.size());
  std::size_t count = 0;
  for (;;) {
    if (count == kFieldsMax) return kFieldsMax + 1;
    if (line.empty() || line.front() != '"') {
      const std::size_t length = std::min(line.find(','), line.size());
      fields_[count++] = line.substr(0, length);
      if (length == line.size()) return count;
      line.remove_prefix(length + 1);
      continue;
    }
    line.remove_prefix(1);
    const std::size_t begin = unquoted_.size();
    for (;;) {
      const std::size_t quote = line.find('"');
      if (quote == std::string_view::npos) return 0;
      unquoted_.append(line.substr(0, quote));
      line.remove_prefix(quote + 1);
      if (line.empty() || line.front() != '"') break;
      unquoted_ += '"';
      line.remove_prefix(1);
    }
    fields_[count++] = std::string_view{unquoted_}.substr(begin);
    if (line.empty()) return count;
    if (line.front() != ',') return 0;  // text after a closing quote
    line.remove_prefix(1);
  }
}

namespace {

constexpr std::size_t kPlainMax = 16;  // so at most 15 digits are read
constexpr std::array<double, 16> kPowersOfTen{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                              1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

}  // namespace

std::string in_quotes(std::string_view text) {
  std::string quoted{"'"};
  quoted += printable(text);
  quoted += '\'';
  return quoted;
}

std::size_t parse_plain_decimal(std::string_view text, double& value) {
  const std::size_t sign = !text.empty() && text.front() == '-' ? 1 : 0;
  std::int64_t digits = 0;
  std::size_t i = sign;
  for (; i < text.size() && is_digit(text[i]) && i < kPlainMax; ++i) {
    digits = 10 * digits + (text[i] - '0');
  }
  if (i == sign) return 0;
  std::size_t decimals = 0;
  if (i + 1 < text.size() && text[i] == '.' && is_digit(text[i + 1])) {
    const std::size_t point = i++;
    for (; i < text.size() && is_digit(text[i]) && i < kPlainMax; ++i) {
      digits = 10 * digits + (text[i] - '0');
    }
    decimals = i - point - 1;
  }
  if (i >= kPlainMax) return 0;
  const double magnitude = static_cast<double>(digits) / kPowersOfTen[decimals];
  value = sign == 1 ? -magnitude : magnitude;
  return i;
}

std::optional<double> parse_number(std::string_view text) {
  double plain = 0.0;
  if (!text.empty() && parse_plain_decimal(text, plain) == text.size()) return plain;
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

bool is_digits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

std::string number_problem(std::string_view name, std::string_view text) {
  std::string dotted{text};
  const auto comma = dotted.find(',');
  if (comma != std::string::npos) {
    dotted[comma] = '.';
    if (parse_number(dotted)) {
      return std::string{name} + " '" + std::string{text} + "' has a decimal comma; write " +
             dotted;
    }
  }
  return std::string{name} + " " + in_quotes(text) +
         " is not a finite number; leave the field blank where nothing was measured";
}

Result<Instant> parse_timestamp(std::string_view text) {
  const int year = digits(text, 0, 4);
  const int month = digits(text, 5, 2);
  const int day = digits(text, 8, 2);
  const int hour = digits(text, 11, 2);
  const int minute = digits(text, 14, 2);
  const bool shaped = year >= 0 && has(text, 4, '-') && month >= 0 && has(text, 7, '-') &&
                      day >= 0 && (has(text, 10, 'T') || has(text, 10, ' ')) && hour >= 0 &&
                      has(text, 13, ':') && minute >= 0;
  if (!shaped) {
    return tl::unexpected(bad_stamp(text, "is not ISO 8601; write 2016-03-01T00:15:00Z"));
  }
  std::size_t at = 16;
  int second = 0;
  if (has(text, at, ':')) {
    second = digits(text, at + 1, 2);
    at += 3;
    if (has(text, at, '.')) {
      ++at;
      while (has(text, at, '0')) ++at;
    }
  }
  const std::chrono::year_month_day date{std::chrono::year{year},
                                         std::chrono::month{static_cast<unsigned>(month)},
                                         std::chrono::day{static_cast<unsigned>(day)}};
  const bool end_of_day = hour == 24 && minute == 0 && second == 0;
  if (!date.ok() || (hour > 23 && !end_of_day) || minute > 59 || second < 0 || second > 59) {
    return tl::unexpected(bad_stamp(text, "is no date and time of the calendar"));
  }
  const auto offset = parse_offset(text.substr(std::min(at, text.size())));
  if (!offset) {
    return tl::unexpected(
        bad_stamp(text, "has no offset from UTC; end it with Z or an offset such as -06:00"));
  }
  const Instant instant =
      Instant{std::chrono::sys_days{date}} + seconds{hour * 3600 + minute * 60 + second} - *offset;
  if (year < 1971 || instant >= metering::kLatestInstant) {
    return failure(ErrorCode::out_of_range, "timestamp '" + std::string{text} + "' lies outside " +
                                                std::string{metering::kKnownYears});
  }
  return instant;
}

}  // namespace recald::csv
