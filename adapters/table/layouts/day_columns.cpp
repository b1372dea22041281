#include "adapters/table/layouts/day_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "adapters/csv/fields.hpp"
#include "adapters/table/sniff.hpp"
#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

constexpr int kDay_min = 1440;
constexpr int kHour_min = 60;
constexpr std::array kSteps_min{60, 30, 15, 10, 5};
constexpr std::size_t kLabelMax = 60;     // bytes of a label
constexpr std::size_t kHeaderMax = 2000;  // columns; each is looked at as the first of a day

/// How a label writes its time.
enum class LabelKind : std::uint8_t { clock, clock_range, hour_range, number };

struct DayLabel {
  LabelKind kind;
  std::string around;  ///< The text without its figures, the same in all labels of a run.
  int value = 0;       ///< Minutes after midnight, or the number.
  int digits = 0;      ///< Of the number.
};

bool is_cipher(char c) { return c >= '0' && c <= '9'; }

/// A number of up to four digits at `at`, which moves behind it.
std::optional<int> take_number(std::string_view text, std::size_t& at) {
  int value = 0;
  const std::size_t begin = at;
  while (at < text.size() && is_cipher(text[at])) {
    if (at - begin == 4) return {};
    value = 10 * value + (text[at++] - '0');
  }
  return at == begin ? std::nullopt : std::optional{value};
}

void skip_blanks(std::string_view text, std::size_t& at) {
  while (at < text.size() && (text[at] == ' ' || text[at] == '\t')) ++at;
}

/// "am" or "pm" behind an hour of 1 to 12: the hour of the day.
std::optional<int> take_half(std::string_view text, std::size_t& at, int hour) {
  std::size_t after = at;
  skip_blanks(text, after);
  const std::string_view half = text.substr(std::min(after, text.size()), 2);
  if ((half != "am" && half != "pm") || hour < 1 || hour > 12) return {};
  at = after + 2;
  return hour % 12 + (half == "pm" ? 12 : 0);
}

/// "0:15", "00.15", "00h15", "00:15:00", "12:15 am", "1 am". Up to 25:00, for the longer day.
std::optional<int> take_clock(std::string_view text, std::size_t& at) {
  std::size_t now = at;
  const auto hour = take_number(text, now);
  if (!hour || now - at > 2 || *hour > 25) return {};
  if (const auto of_day = take_half(text, now, *hour)) {
    at = now;
    return *of_day * kHour_min;
  }
  if (now >= text.size() || std::string_view{":.h"}.find(text[now]) == std::string_view::npos) {
    return {};
  }
  const bool is_hour_alone =
      text[now] == 'h' && (now + 1 == text.size() || !is_cipher(text[now + 1]));
  ++now;
  if (is_hour_alone) {
    at = now;
    return *hour * kHour_min;
  }
  const std::size_t minutes_at = now;
  const auto minute = take_number(text, now);
  if (!minute || now - minutes_at != 2 || *minute > 59) return {};
  if (now + 2 < text.size() && (text[now] == ':' || text[now] == '.') && is_cipher(text[now + 1]) &&
      is_cipher(text[now + 2])) {
    now += 3;
  }
  int time_min = *hour * kHour_min + *minute;
  if (const auto of_day = take_half(text, now, *hour)) time_min = *of_day * kHour_min + *minute;
  at = now;
  return time_min;
}

/// What stands between the two ends of a range.
bool skip_until_sign(std::string_view text, std::size_t& at) {
  std::size_t now = at;
  skip_blanks(text, now);
  constexpr std::array<std::string_view, 9> kSigns{"-",   "\xE2\x80\x93", "\xE2\x80\x94", "~", "/",
                                                   "to ", "bis ",         "tot ",         "a "};
  for (const std::string_view sign : kSigns) {
    if (text.substr(now, sign.size()) != sign) continue;
    at = now + sign.size();
    skip_blanks(text, at);
    return true;
  }
  return false;
}

/// The label with its time left out, and with it what marks the hour that comes a second time.
std::string without(std::string_view text, std::size_t begin, std::size_t end) {
  std::string_view behind = csv::trimmed(text.substr(end));
  constexpr std::array<std::string_view, 8> kAgain{"(dst)", "dst", "(2)", "a", "b", "x", "*", "'"};
  for (const std::string_view mark : kAgain) {
    if (behind == mark) behind = {};
  }
  return std::string{text.substr(0, begin)} + '#' + std::string{behind};
}

/// A label with a clock time, or with two.
std::optional<DayLabel> clock_label(std::string_view text) {
  for (std::size_t begin = 0; begin < text.size(); ++begin) {
    if (!is_cipher(text[begin]) || (begin > 0 && is_cipher(text[begin - 1]))) continue;
    std::size_t end = begin;
    const auto start = take_clock(text, end);
    if (!start) continue;
    std::size_t second = end;
    if (skip_until_sign(text, second) && take_clock(text, second)) {
      return DayLabel{LabelKind::clock_range, without(text, begin, second), *start};
    }
    return DayLabel{LabelKind::clock, without(text, begin, end), *start};
  }
  return {};
}

/// "0-1", "00 - 01": hours from and to.
std::optional<DayLabel> hours_label(std::string_view text) {
  const std::size_t begin = text.find_first_of("0123456789");
  if (begin == std::string_view::npos) return {};
  std::size_t end = begin;
  const auto from = take_number(text, end);
  if (!from || !skip_until_sign(text, end)) return {};
  const auto to = take_number(text, end);
  if (!to || (*to != *from + 1 && !(*from == 23 && *to == 0))) return {};
  return DayLabel{LabelKind::hour_range, without(text, begin, end), *from * kHour_min};
}

/// The last number of a label: "h01", "kwh_0030", "interval 1 (kwh)".
std::optional<DayLabel> number_label(std::string_view text) {
  const std::size_t last = text.find_last_of("0123456789");
  if (last == std::string_view::npos) return {};
  std::size_t begin = last;
  while (begin > 0 && is_cipher(text[begin - 1])) --begin;
  std::size_t end = begin;
  const auto number = take_number(text, end);
  if (!number) return {};
  return DayLabel{LabelKind::number, without(text, begin, end), *number,
                  static_cast<int>(end - begin)};
}

using Labels = std::vector<std::optional<DayLabel>>;
using Reader = std::optional<DayLabel> (*)(std::string_view);

/// The labels of one kind that go on from `first`, as numbers.
std::vector<int> run_from(const Labels& labels, std::size_t first, std::size_t stride) {
  std::vector<int> values;
  for (std::size_t i = first; i < labels.size(); i += stride) {
    if (!labels[i] || labels[i]->kind != labels[first]->kind) break;
    if (labels[i]->around != labels[first]->around) break;
    values.push_back(labels[i]->value);
  }
  return values;
}

/// Starts of the intervals whose labels are these times, from the run's front. Empty where they do
/// not go on in equal steps through a whole day.
std::vector<int> starts_of_clock(const std::vector<int>& times_min, int step_min, bool& repeats) {
  const std::size_t usual = static_cast<std::size_t>(kDay_min / step_min);
  const std::size_t in_hour = static_cast<std::size_t>(kHour_min / step_min);
  if (times_min.empty()) return {};
  // Labels are starts from midnight on, or ends that begin a step after it.
  const int shift = times_min.front();
  if (shift != 0 && shift != step_min) return {};
  std::vector<int> starts;
  int expected = 0;
  for (const int time : times_min) {
    const int start = time - shift;
    const bool is_midnight_at_end = time == 0 && shift != 0 && expected == kDay_min - step_min;
    const bool is_back = !repeats && starts.size() >= in_hour && start == expected - kHour_min &&
                         expected < kDay_min;
    if (is_back) {
      repeats = true;
      expected = start;
    } else if (start != expected && !is_midnight_at_end) {
      break;
    }
    starts.push_back(expected);
    expected += step_min;
  }
  const std::size_t longest = usual + in_hour;
  if (starts.size() == usual && !repeats) return starts;
  return starts.size() == longest ? starts : std::vector<int>{};
}

/// "0030" and "2400" as minutes; empty if one is no such time.
std::vector<int> as_clock(const std::vector<int>& numbers) {
  std::vector<int> times;
  for (const int number : numbers) {
    if (number % 100 > 59 || number > 2500) break;
    times.push_back(number / 100 * kHour_min + number % 100);
  }
  return times;
}

std::string unit_in(std::string_view label) {
  std::string text{label};
  std::erase(text, '#');
  std::ranges::replace(text, '_', ' ');
  const std::string_view inside = csv::trimmed(text);
  if (is_unit(inside) && inside.size() > 1) return std::string{inside};
  return split_unit(inside).unit;
}

/// The day that begins in this column, if one does.
std::optional<DayColumns> day_from(const Labels& labels, std::size_t first, std::size_t stride) {
  const std::vector<int> values = run_from(labels, first, stride);
  const LabelKind kind = labels[first]->kind;
  for (const int step_min : kSteps_min) {
    if (values.size() < static_cast<std::size_t>(kDay_min / step_min)) continue;
    DayColumns found{.first = first, .stride = stride, .step_min = step_min};
    if (kind == LabelKind::number) {
      // Numbers from 1 count the ends of intervals, those from 0 their starts.
      std::vector<int> times_min = values;
      for (int& time : times_min) time *= step_min;
      found.starts_min = starts_of_clock(times_min, step_min, found.repeats_an_hour);
      if (found.starts_min.empty() && labels[first]->digits >= 3) {
        found.repeats_an_hour = false;
        found.starts_min = starts_of_clock(as_clock(values), step_min, found.repeats_an_hour);
      }
    } else {
      found.starts_min = starts_of_clock(values, step_min, found.repeats_an_hour);
    }
    if (found.starts_min.empty()) continue;
    return found;
  }
  return {};
}

}  // namespace

std::optional<DayColumns> find_day_columns(std::span<const std::string_view> header) {
  if (header.size() < 24 || header.size() > kHeaderMax) return {};
  for (const Reader reader : {Reader{clock_label}, Reader{hours_label}, Reader{number_label}}) {
    Labels labels;
    for (const std::string_view cell : header) {
      labels.push_back(cell.size() > kLabelMax ? std::nullopt : reader(to_lower(cell)));
    }
    for (std::size_t first = 0; first < labels.size(); ++first) {
      if (!labels[first]) continue;
      for (const std::size_t stride : {std::size_t{1}, std::size_t{2}}) {
        auto found = day_from(labels, first, stride);
        if (!found) continue;
        std::string around{header[first]};
        std::erase_if(around, [](char c) { return is_cipher(c) || c == ':'; });
        found->unit = unit_in(around);
        return found;
      }
    }
  }
  return {};
}

}  // namespace recald::table
