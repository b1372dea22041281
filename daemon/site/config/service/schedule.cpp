#include "daemon/site/config/service/schedule.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string>
#include <vector>

namespace recald::daemon {
namespace {

using metering::Day;
using metering::Instant;

struct FieldForm {
  std::string_view name;
  int min;
  int max;
};
constexpr std::array<FieldForm, 5> kFields{
    {{"minute", 0, 59}, {"hour", 0, 23}, {"day", 1, 31}, {"month", 1, 12}, {"weekday", 0, 7}}};

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::optional<int> whole(std::string_view text) {
  int value = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc{} || read.ptr != end) return {};
  return value;
}

tl::unexpected<Error> refused(const FieldForm& form, std::string_view text) {
  return failure(
      ErrorCode::malformed,
      fmt::format(
          "the {} '{}' is not valid; write numbers from {} to {}, such as *, 5, 1-3, 1,15 or */10",
          form.name, text, form.min, form.max));
}

/// One part of a list: "*", "5", "1-3", each with "/step".
template <std::size_t N>
bool add_part(std::string_view part, const FieldForm& form, std::bitset<N>& set) {
  int step = 1;
  if (const auto slash = part.find('/'); slash != std::string_view::npos) {
    const auto given = whole(part.substr(slash + 1));
    if (!given || *given < 1) return false;
    step = *given;
    part = part.substr(0, slash);
  }
  std::optional<int> first = form.min;
  std::optional<int> last = form.max;
  if (part != "*") {
    const auto dash = part.find('-');
    first = whole(part.substr(0, dash));
    last = dash == std::string_view::npos ? first : whole(part.substr(dash + 1));
  }
  if (!first || !last || *first < form.min || *last > form.max || *last < *first) return false;
  for (int value = *first; value <= *last; value += step) {
    set.set(static_cast<std::size_t>(value) % N);  // weekday 7 is Sunday too
  }
  return true;
}

template <std::size_t N>
Result<void> read_field(std::string_view text, const FieldForm& form, std::bitset<N>& set) {
  for (const std::string_view part : split(text, ',')) {
    if (!add_part(part, form, set)) return refused(form, text);
  }
  return {};
}

Result<CalendarTimes> parse_times(const std::vector<std::string_view>& fields) {
  CalendarTimes times;
  if (auto r = read_field(fields[0], kFields[0], times.minutes); !r)
    return tl::unexpected(r.error());
  TRY(read_field(fields[1], kFields[1], times.hours));
  TRY(read_field(fields[2], kFields[2], times.days));
  if (auto r = read_field(fields[3], kFields[3], times.months); !r)
    return tl::unexpected(r.error());
  if (auto r = read_field(fields[4], kFields[4], times.weekdays); !r)
    return tl::unexpected(r.error());
  times.any_day = fields[2] == "*";
  times.any_weekday = fields[4] == "*";
  return times;
}

bool is_day(const CalendarTimes& times, const Day& day) {
  if (!times.months[static_cast<unsigned>(day.month())]) return false;
  const bool day_fits = times.days[static_cast<unsigned>(day.day())];
  const std::chrono::weekday weekday{std::chrono::sys_days{day}};
  const bool weekday_fits = times.weekdays[weekday.c_encoding()];
  if (times.any_day || times.any_weekday) return day_fits && weekday_fits;
  return day_fits || weekday_fits;
}

}  // namespace

std::optional<Instant> CalendarTimes::next(Instant t,
                                           const metering::LocalCalendar& calendar) const {
  constexpr int kDays = 4 * 366;  // 29 February comes once in four years
  auto date = std::chrono::sys_days{calendar.local_time(t).date};
  for (int i = 0; i < kDays; ++i, date += std::chrono::days{1}) {
    const Day day{date};
    if (!is_day(*this, day)) continue;
    for (int minute = 0; minute < 24 * 60; ++minute) {
      if (!hours[static_cast<std::size_t>(minute / 60)]) continue;
      if (!minutes[static_cast<std::size_t>(minute % 60)]) continue;
      const Instant at = calendar.first_instant(day, minute);
      if (at > t) return at;
    }
  }
  return {};
}

Result<Schedule> parse_schedule(std::string_view text) {
  if (text == "monthly") return Schedule{.when_a_month_closes = true, .times = {}};
  if (text == "never") return Schedule{};
  std::vector<std::string_view> fields;
  for (const std::string_view field : split(text, ' ')) {
    if (!field.empty()) fields.push_back(field);
  }
  if (fields.size() != kFields.size()) {
    return failure(ErrorCode::malformed,
                   fmt::format("'{}' is not a schedule; write \"monthly\", \"never\" or five "
                               "fields \"minute hour day month weekday\" such as \"30 3 5 * *\"",
                               text));
  }
  auto times = TRY(parse_times(fields));
  return Schedule{.when_a_month_closes = false, .times = times};
}

}  // namespace recald::daemon
