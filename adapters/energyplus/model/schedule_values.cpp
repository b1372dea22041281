#include "adapters/energyplus/model/schedule_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bitset>
#include <charconv>
#include <utility>

#include "adapters/energyplus/model/fields.hpp"
#include "core/text/ascii.hpp"

namespace recald::energyplus {
namespace {

using Kinds = std::bitset<kDayKinds>;

constexpr std::array<std::string_view, kDayKinds> kNames{
    "sunday",   "monday",  "tuesday",         "wednesday",       "thursday",   "friday",
    "saturday", "holiday", "summerdesignday", "winterdesignday", "customday1", "customday2"};

Kinds one(DayKind kind) { return Kinds{}.set(kind); }
Kinds weekdays() {
  Kinds days;
  for (std::size_t day = kMonday; day <= kFriday; ++day) days.set(day);
  return days;
}

/// "Weekdays SummerDesignDay"; none: no such kind of day.
std::optional<Kinds> kinds_of(std::string_view words, const Kinds& covered) {
  Kinds all;
  std::string word;
  const auto take = [&] {
    if (word.empty()) return true;
    if (word.back() == 's' && word != "weekdays" && word != "weekends" && word != "alldays" &&
        word != "allotherdays") {
      word.pop_back();  // holidays
    }
    const auto known = std::ranges::find(kNames, word);
    if (known != kNames.end()) {
      all.set(static_cast<std::size_t>(known - kNames.begin()));
    } else if (word == "weekdays" || word == "weekday") {
      all |= weekdays();
    } else if (word == "weekends" || word == "weekend") {
      all |= one(kSaturday) | one(kSunday);
    } else if (word == "alldays") {
      all.set();
    } else if (word == "allotherdays") {
      all |= ~covered;
    } else {
      return false;
    }
    word.clear();
    return true;
  };
  for (const char letter : words) {
    if (letter == ' ' || letter == ',') {
      if (!take()) return {};
    } else {
      word += letter;
    }
  }
  if (!take()) return {};
  return all;
}

/// "8:00"
std::optional<int> minute_of(std::string_view clock) {
  int hour = 0;
  int minute = 0;
  const char* const end = clock.data() + clock.size();
  const auto hours = std::from_chars(clock.data(), end, hour);
  if (hours.ec != std::errc{} || hours.ptr == end || *hours.ptr != ':') return {};
  if (std::from_chars(hours.ptr + 1, end, minute).ec != std::errc{}) return {};
  const int all = 60 * hour + minute;
  return all > 0 && all <= kMinutesADay ? std::optional{all} : std::nullopt;
}

/// "12/31"
std::optional<std::pair<int, int>> date_of(std::string_view text) {
  int month = 0;
  int day = 0;
  const char* const end = text.data() + text.size();
  const auto months = std::from_chars(text.data(), end, month);
  if (months.ec != std::errc{} || months.ptr == end || *months.ptr != '/') return {};
  if (std::from_chars(months.ptr + 1, end, day).ec != std::errc{}) return {};
  return std::pair{month, day};
}

/// What follows a word such as "through:", without blanks around it; none: another word.
std::optional<std::string_view> after(std::string_view line, std::string_view word) {
  if (!line.starts_with(word)) return {};
  line.remove_prefix(word.size());
  const auto first = line.find_first_not_of(" :");
  if (first == std::string_view::npos) return "";
  const auto last = line.find_last_not_of(' ');
  return line.substr(first, last - first + 1);
}

bool is_whole(const ScheduleValues& schedule) {
  return !schedule.spans.empty() && std::ranges::all_of(schedule.spans, [](const auto& span) {
    return std::ranges::all_of(span.days, [](const DayValues& day) {
      return !day.empty() && day.back().minute == kMinutesADay;
    });
  });
}

/// A number, or a text that is one.
std::optional<double> number_in(const Json& field) {
  if (field.is_number()) return field.get<double>();
  if (!field.is_string()) return {};
  const std::string text = field.get<std::string>();
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc{} && read.ptr == text.data() + text.size() ? std::optional{value}
                                                                         : std::nullopt;
}

std::optional<ScheduleValues> read_compact(const Json& object) {
  ScheduleValues schedule{text_of(object, "schedule_type_limits_name"), {}};
  Kinds covered;
  Kinds now;
  int until = 0;  // minute; 0: no value is due
  const auto data = object.find("data");
  if (data == object.end() || !data->is_array()) return {};
  for (const Json& entry : *data) {
    const auto field = entry.find("field");
    if (field == entry.end()) continue;
    if (const auto value = number_in(*field)) {
      if (until == 0 || schedule.spans.empty()) return {};
      for (std::size_t kind = 0; kind < kDayKinds; ++kind) {
        if (now[kind]) schedule.spans.back().days[kind].push_back({until, *value});
      }
      until = 0;
      continue;
    }
    if (!field->is_string()) return {};
    const std::string line = to_lower(field->get<std::string>());
    if (const auto date = after(line, "through")) {
      const auto day = date_of(*date);
      if (!day) return {};
      schedule.spans.push_back({day->first, day->second, {}});
      covered.reset();
    } else if (const auto words = after(line, "for")) {
      const auto kinds = kinds_of(*words, covered);
      if (!kinds) return {};
      now = *kinds & ~covered;  // the first that speaks of a day counts
      covered |= *kinds;
    } else if (const auto clock = after(line, "until")) {
      until = minute_of(*clock).value_or(0);
      if (until == 0) return {};
    } else if (const auto how = after(line, "interpolate"); !how || *how != "no") {
      return {};
    }
  }
  return is_whole(schedule) ? std::optional{std::move(schedule)} : std::nullopt;
}

/// The object of one of the types with this name; null: none.
const Json* find_named(const Json& objects, std::string_view type, std::string_view name) {
  for (const auto& [own, object] : objects_of(objects, type)) {
    if (equals_ignoring_case(own, name)) return object;
  }
  return nullptr;
}

std::optional<DayValues> read_day(const Json& objects, std::string_view name) {
  DayValues day;
  if (const Json* hourly = find_named(objects, "Schedule:Day:Hourly", name)) {
    for (int hour = 1; hour <= 24; ++hour) {
      day.push_back({60 * hour, number_of(*hourly, fmt::format("hour_{}", hour))});
    }
    return day;
  }
  const Json* interval = find_named(objects, "Schedule:Day:Interval", name);
  if (interval == nullptr || !interval->contains("data")) return {};
  if (to_lower(text_of(*interval, "interpolate_to_timestep", "No")) != "no") return {};
  for (const Json& entry : interval->at("data")) {
    const auto until = minute_of(text_of(entry, "time"));
    if (!until) return {};
    day.push_back({*until, number_of(entry, "value_until_time")});
  }
  return day;
}

std::optional<ScheduleValues> read_year(const Json& objects, const Json& year) {
  ScheduleValues schedule{text_of(year, "schedule_type_limits_name"), {}};
  const auto weeks = year.find("schedule_weeks");
  if (weeks == year.end() || !weeks->is_array()) return {};
  for (const Json& part : *weeks) {
    const Json* week =
        find_named(objects, "Schedule:Week:Daily", text_of(part, "schedule_week_name"));
    if (week == nullptr) return {};
    ScheduleSpan span{static_cast<int>(number_of(part, "end_month")),
                      static_cast<int>(number_of(part, "end_day")),
                      {}};
    for (std::size_t kind = 0; kind < kDayKinds; ++kind) {
      auto day =
          read_day(objects, text_of(*week, fmt::format("{}_schedule_day_name", kNames[kind])));
      if (!day) return {};
      span.days[kind] = std::move(*day);
    }
    schedule.spans.push_back(std::move(span));
  }
  return is_whole(schedule) ? std::optional{std::move(schedule)} : std::nullopt;
}

std::string clock_of(int minute) { return fmt::format("{:02}:{:02}", minute / 60, minute % 60); }

constexpr std::array<const char*, kDayKinds> kWritten{
    "Sunday",   "Monday",  "Tuesday",         "Wednesday",       "Thursday",   "Friday",
    "Saturday", "Holiday", "SummerDesignDay", "WinterDesignDay", "CustomDay1", "CustomDay2"};

}  // namespace

std::optional<ScheduleValues> read_schedule(const Json& objects, std::string_view name) {
  if (const Json* compact = find_named(objects, "Schedule:Compact", name)) {
    return read_compact(*compact);
  }
  if (const Json* constant = find_named(objects, "Schedule:Constant", name)) {
    ScheduleValues schedule{text_of(*constant, "schedule_type_limits_name"), {{12, 31, {}}}};
    schedule.spans.front().days.fill({{kMinutesADay, number_of(*constant, "hourly_value")}});
    return schedule;
  }
  const Json* year = find_named(objects, "Schedule:Year", name);
  return year == nullptr ? std::nullopt : read_year(objects, *year);
}

Json compact_schedule(const ScheduleValues& schedule) {
  Json data = Json::array();
  const auto line = [&](const std::string& text) { data.push_back({{"field", text}}); };
  for (const ScheduleSpan& span : schedule.spans) {
    line(fmt::format("Through: {}/{}", span.month, span.day));
    Kinds covered;
    for (std::size_t kind = 0; kind < kDayKinds; ++kind) {
      if (covered[kind]) continue;
      std::string days = "For:";
      for (std::size_t other = kind; other < kDayKinds; ++other) {
        if (span.days[other] != span.days[kind]) continue;
        covered.set(other);
        days += fmt::format(" {}", kWritten[other]);
      }
      line(days);
      for (const UntilValue& part : span.days[kind]) {
        line("Until: " + clock_of(part.minute));
        data.push_back({{"field", part.value}});
      }
    }
  }
  Json object;
  if (!schedule.type_limits.empty()) object["schedule_type_limits_name"] = schedule.type_limits;
  object["data"] = std::move(data);
  return object;
}

}  // namespace recald::energyplus
