#include "adapters/table/cells/stamp_parts.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "adapters/table/cells/words.hpp"
#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;

constexpr std::string_view kDateSigns = "-/. ,";

/// Between the parts of a date: "1. September 2025", "1 de septiembre de 2025".
void skip_apart(Scanner& scan) {
  scan.skip(kDateSigns);
  if (scan.take("de ")) scan.skip(kDateSigns);
}

std::optional<int> take_month(Scanner& scan) {
  if (!scan.is_at_letter()) return scan.number(2);
  const std::string_view name = scan.word();
  const int month = month_named(to_lower(name.substr(0, 15)));
  return month == 0 ? std::nullopt : std::optional{month};
}

std::optional<int> take_year(Scanner& scan) {
  const auto year = scan.number(4);
  if (!year || (scan.digits() != 4 && scan.digits() != 2)) return {};
  if (scan.digits() == 4) return year;
  return *year + (*year < 70 ? 2000 : 1900);
}

/// "am", "P.M.", "p. m." after the hour of a clock with twelve. @return 'a', 'p' or nothing
std::optional<char> take_half(Scanner& scan) {
  Scanner ahead = scan;
  ahead.skip(" ");
  const char half = to_lower(ahead.front());
  if (half != 'a' && half != 'p') return {};
  ahead.take(ahead.front());
  ahead.take('.');
  ahead.skip(" ");
  if (to_lower(ahead.front()) != 'm') return {};
  ahead.take(ahead.front());
  if (ahead.is_at_letter()) return {};
  ahead.take('.');
  scan = ahead;
  return half;
}

struct NamedOffset {
  std::string_view letters;
  int east_minutes;
};

// Letters with several meanings have the one of Europe or North America; who reads them checks
// that it fits the building's zone.
constexpr auto kOffsets = std::to_array<NamedOffset>(
    {{"z", 0},      {"utc", 0},    {"gmt", 0},     {"ut", 0},      {"wet", 0},    {"west", 60},
     {"bst", 60},   {"cet", 60},   {"mez", 60},    {"met", 60},    {"cest", 120}, {"mesz", 120},
     {"mest", 120}, {"eet", 120},  {"oez", 120},   {"sast", 120},  {"eest", 180}, {"oesz", 180},
     {"msk", 180},  {"trt", 180},  {"sgt", 480},   {"hkt", 480},   {"awst", 480}, {"jst", 540},
     {"kst", 540},  {"acst", 570}, {"aest", 600},  {"acdt", 630},  {"aedt", 660}, {"nzst", 720},
     {"nzdt", 780}, {"hst", -600}, {"akst", -540}, {"akdt", -480}, {"pst", -480}, {"pdt", -420},
     {"mst", -420}, {"mdt", -360}, {"cst", -360},  {"cdt", -300},  {"est", -300}, {"edt", -240},
     {"ast", -240}, {"adt", -180}, {"nst", -210},  {"ndt", -150},  {"brt", -180}});

}  // namespace

std::optional<int> Scanner::number(std::size_t most) {
  int value = 0;
  std::size_t count = 0;
  while (count < most && is_at_figure()) {
    value = 10 * value + (front() - '0');
    text_.remove_prefix(1);
    ++count;
  }
  if (count == 0) return {};
  digits_ = count;
  return value;
}

std::string_view Scanner::word() {
  const std::string_view begin = text_;
  while (is_at_letter()) text_.remove_prefix(1);
  return begin.substr(0, begin.size() - text_.size());
}

std::optional<std::chrono::sys_days> take_date(Scanner& scan, TimeFormat format) {
  std::optional<int> year;
  std::optional<int> month;
  std::optional<int> day;
  if (format == TimeFormat::year_first) {
    year = take_year(scan);
    if (!year || scan.digits() != 4) return {};
    skip_apart(scan);
    month = take_month(scan);
    skip_apart(scan);
    day = scan.number(2);
  } else {
    if (format == TimeFormat::day_first) day = scan.number(2);
    if (format == TimeFormat::month_first) month = take_month(scan);
    skip_apart(scan);
    if (format == TimeFormat::day_first) month = take_month(scan);
    if (format == TimeFormat::month_first) day = scan.number(2);
    skip_apart(scan);
    year = take_year(scan);
  }
  if (!year || !month || !day) return {};
  const std::chrono::year_month_day date{std::chrono::year{*year},
                                         std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  return date.ok() ? std::optional{std::chrono::sys_days{date}} : std::nullopt;
}

std::optional<seconds> take_time(Scanner& scan) {
  const auto hour = scan.number(2);
  if (!hour) return {};
  const bool has_dot = scan.take('.');
  const bool has_colon = has_dot || scan.take(':') || scan.take('h') || scan.take('H');
  if (!has_colon && !scan.is_at_figure()) return {};
  const auto minute = scan.number(2);
  if (!minute || scan.digits() != 2) return {};
  int second = 0;
  if (scan.take(':') || (has_dot && scan.take('.')) || (!has_colon && scan.is_at_figure())) {
    const auto given = scan.number(2);
    if (!given || scan.digits() != 2) return {};
    second = *given;
    if (scan.take('.') || scan.take(',')) scan.skip("0123456789");
  }
  int hour_of_day = *hour;
  if (const auto half = take_half(scan)) {
    if (hour_of_day < 1 || hour_of_day > 12) return {};
    hour_of_day = hour_of_day % 12 + (*half == 'p' ? 12 : 0);
  }
  const bool is_end_of_day = hour_of_day == 24 && *minute == 0 && second == 0;
  if ((hour_of_day > 23 && !is_end_of_day) || *minute > 59 || second > 59) return {};
  return seconds{hour_of_day * 3600 + *minute * 60 + second};
}

std::optional<seconds> take_numeric_offset(Scanner& scan, std::size_t hour_digits_min) {
  Scanner ahead = scan;
  const bool is_west = ahead.front() == '-';
  if (!ahead.take('-') && !ahead.take('+')) return {};
  const auto hour = ahead.number(2);
  if (!hour || ahead.digits() < hour_digits_min || *hour > (is_west ? 12 : 14)) return {};
  int minute = 0;
  const bool is_apart = ahead.take(':');
  if (is_apart || ahead.is_at_figure()) {
    const auto given = ahead.number(2);
    if (!given || ahead.digits() != 2 || *given > 59 || ahead.is_at_figure()) return {};
    minute = *given;
  }
  scan = ahead;
  const seconds east{*hour * 3600 + minute * 60};
  return is_west ? -east : east;
}

std::optional<seconds> offset_named(std::string_view letters) {
  const std::string lower = to_lower(letters.substr(0, 8));
  const auto known = std::find_if(kOffsets.begin(), kOffsets.end(),
                                  [&](const NamedOffset& one) { return one.letters == lower; });
  return known == kOffsets.end() ? std::nullopt
                                 : std::optional<seconds>{minutes{known->east_minutes}};
}

}  // namespace recald::table
