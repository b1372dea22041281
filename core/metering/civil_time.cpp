#include "core/metering/civil_time.hpp"

#include <date/tz.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <stdexcept>

#include "core/metering/zone_rule.hpp"
#include "core/text/ascii.hpp"
#include "core/text/nearest.hpp"

namespace recald::metering {
namespace {

using std::chrono::days;
using std::chrono::seconds;
using std::chrono::sys_days;

constexpr Instant kEarliestInstant =
    sys_days{Day{std::chrono::year{1970}, std::chrono::month{1}, std::chrono::day{1}}};

/// The transitions of a zone over the years we accept. A zone has about two per year, so we search
/// a flat vector instead of using the library's lookup, which builds strings on each call. The
/// library ends with the last transition that the file lists, in 2037 or long before.
std::vector<OffsetSpan> offsets_of(const date::time_zone& zone) {
  std::vector<OffsetSpan> offsets;
  Instant t = kEarliestInstant;
  while (t < kLatestInstant) {
    const date::sys_info info = zone.get_info(t);
    const Instant end = std::min(info.end, kLatestInstant);
    offsets.push_back({{t, end}, info.offset});
    t = end;
  }
  const Instant last_listed = offsets.back().span.begin;
  for (const OffsetChange& change : zone_rule_changes(zone_rule_of(zone.name()))) {
    if (change.at <= last_listed || change.at >= kLatestInstant) continue;
    offsets.back().span.end = change.at;
    offsets.push_back({{change.at, kLatestInstant}, change.utc_offset});
  }
  return offsets;
}

/// "berlin" of Europe/Berlin
std::string city_of(std::string_view zone_name) {
  return to_lower(zone_name.substr(zone_name.rfind('/') + 1));
}

/// The zone whose city is called most alike: the part of the world says little of what was meant.
std::string zone_like(std::string_view zone_name) {
  const auto& zones = date::get_tzdb().zones;
  std::vector<std::string> cities;
  for (const date::time_zone& zone : zones) cities.push_back(city_of(zone.name()));
  const std::vector<std::string_view> names(cities.begin(), cities.end());
  const std::string_view nearest = nearest_name(city_of(zone_name), names, 1.0 / 3.0);
  if (nearest.empty()) return {};
  return zones[static_cast<std::size_t>(std::ranges::find(names, nearest) - names.begin())].name();
}

int parse_digits(std::string_view text) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole ? value : -1;
}

}  // namespace

Result<LocalCalendar> LocalCalendar::open(std::string_view zone_name) {
  try {
    LocalCalendar calendar;
    calendar.zone_name_ = zone_name;
    calendar.offsets_ = offsets_of(*date::locate_zone(std::string{zone_name}));
    return calendar;
  } catch (const std::runtime_error&) {
    const std::string like = zone_like(zone_name);
    std::string message = "time zone '";
    message += zone_name;
    message += "' is not in this system's zone files; ";
    message +=
        like.empty() ? "use an IANA name such as America/New_York" : "did you mean '" + like + "'?";
    return failure(ErrorCode::not_found, std::move(message));
  }
}

/// Outside the years we accept, where a wrong clock may be, the nearest offset.
const OffsetSpan& LocalCalendar::offset_span(Instant t) const {
  const auto after = std::upper_bound(
      offsets_.begin(), offsets_.end(), t,
      [](Instant instant, const OffsetSpan& entry) { return instant < entry.span.begin; });
  return after == offsets_.begin() ? *after : *std::prev(after);
}

Instant LocalCalendar::first_instant(Day day, int minute_of_day) const {
  const Instant as_if_utc = Instant{sys_days{day}} + std::chrono::minutes{minute_of_day};
  // Offsets are within a day of UTC. Of the spans around, the first whose local times reach the
  // requested one contains its first occurrence, or begins at the jump over it.
  auto entry = std::upper_bound(
      offsets_.begin(), offsets_.end(), as_if_utc - days{1},
      [](Instant instant, const OffsetSpan& candidate) { return instant < candidate.span.begin; });
  if (entry != offsets_.begin()) --entry;
  for (; entry != offsets_.end(); ++entry) {
    const Instant t = as_if_utc - entry->utc_offset;
    if (t < entry->span.begin) return entry->span.begin;
    if (t < entry->span.end) return t;
  }
  return kLatestInstant;
}

TimeSpan LocalCalendar::day_span(Day day) const {
  return {first_instant(day, 0), first_instant(Day{sys_days{day} + days{1}}, 0)};
}

TimeSpan LocalCalendar::month_span(Month month) const {
  return {first_instant(month / 1, 0), first_instant(next_month(month) / 1, 0)};
}

seconds LocalCalendar::utc_offset(Instant t) const { return offset_span(t).utc_offset; }

std::chrono::seconds LocalCalendar::standard_offset(std::chrono::year year) const {
  using std::chrono::sys_days;
  return std::min(utc_offset(sys_days{year / 1 / 15}), utc_offset(sys_days{year / 7 / 15}));
}

LocalTime LocalCalendar::local_time(Instant t) const {
  const Instant wall = t + utc_offset(t);
  const auto midnight = std::chrono::floor<days>(wall);
  return {
      Day{midnight},
      static_cast<int>(std::chrono::duration_cast<std::chrono::minutes>(wall - midnight).count())};
}

Month LocalCalendar::month_of(Instant t) const {
  const Day day = local_time(t).date;
  return day.year() / day.month();
}

int days_in(Month month) {
  return static_cast<int>(static_cast<unsigned>((month / std::chrono::last).day()));
}

Month next_month(Month month) { return month + std::chrono::months{1}; }
Month previous_month(Month month) { return month - std::chrono::months{1}; }
int months_between(Month from, Month to) { return static_cast<int>((to - from).count()); }

std::string to_string(Month month) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u", static_cast<int>(month.year()),
                static_cast<unsigned>(month.month()));
  return text.data();
}

std::string to_string(Day day) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02u", static_cast<int>(day.year()),
                static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
  return text.data();
}

std::string to_string(Instant t) {
  const auto midnight = std::chrono::floor<days>(t);
  const std::chrono::hh_mm_ss clock{t - midnight};
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "T%02d:%02d:%02dZ",
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()));
  return to_string(Day{midnight}) + text.data();
}

Result<Month> parse_month(std::string_view text) {
  const bool shaped = text.size() == 7 && text[4] == '-';
  const int year = shaped ? parse_digits(text.substr(0, 4)) : -1;
  const int month = shaped ? parse_digits(text.substr(5, 2)) : -1;
  const std::chrono::year_month written = std::chrono::year{year} / month;
  constexpr Month kFirst = kFirstKnownYear / std::chrono::January;
  constexpr Month kLast = kLastKnownYear / std::chrono::December;
  if (month < 1 || month > 12 || written < kFirst || written > kLast) {
    return failure(ErrorCode::malformed, "'" + std::string{text} + "' is not a month between " +
                                             to_string(kFirst) + " and " + to_string(kLast) +
                                             "; write YYYY-MM");
  }
  return written;
}

Result<Day> parse_day(std::string_view text) {
  const bool shaped = text.size() == 10 && text[7] == '-';
  const auto month = shaped ? parse_month(text.substr(0, 7)) : Result<Month>{};
  const int day = shaped ? parse_digits(text.substr(8, 2)) : -1;
  if (!shaped || !month || day < 1 || day > days_in(*month)) {
    return failure(ErrorCode::malformed, "'" + std::string{text} + "' is not a date of " +
                                             std::string{kKnownYears} + "; write YYYY-MM-DD");
  }
  return *month / day;
}

}  // namespace recald::metering
