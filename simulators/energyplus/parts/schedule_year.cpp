#include "simulators/energyplus/parts/schedule_year.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <set>

namespace recald::simulators::energyplus {
namespace {

using metering::Day;
using std::chrono::sys_days;

/// Sunday to Saturday, then holidays; design days follow.
constexpr std::size_t kHoliday = 7;
constexpr std::size_t kDayKinds = kHoliday + 1;

struct Span {
  unsigned last_month, last_day;
  std::string week;
};

/// The three tables of the file.
struct Tables {
  std::map<std::string, Quarters> days;
  std::map<std::string, std::array<std::string, kDayKinds>> weeks;
  std::map<std::string, std::vector<Span>> schedules;
};

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return fields;
}

constexpr std::array<const char*, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                              "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};

/// "Through Dec 31"
std::optional<Span> span_of(const std::string& until, const std::string& week) {
  constexpr std::size_t kMonthAt = 8;
  constexpr std::size_t kDayAt = 12;
  if (until.size() <= kDayAt) return std::nullopt;
  const std::string name = until.substr(kMonthAt, 3);
  const auto* const month = std::ranges::find(kMonths, name);
  if (month == kMonths.end()) return std::nullopt;
  return Span{static_cast<unsigned>(month - kMonths.begin()) + 1,
              static_cast<unsigned>(std::atoi(until.c_str() + kDayAt)), week};
}

bool take_day(Tables& tables, const std::vector<std::string>& fields) {
  constexpr std::size_t kFirst = 5;
  if (fields.size() != kFirst + kQuartersPerDay) return false;
  Quarters& values = tables.days[fields[1]];
  for (std::size_t i = 0; i < kQuartersPerDay; ++i) {
    values.push_back(std::strtod(fields[kFirst + i].c_str(), nullptr));
  }
  return true;
}

bool take_week(Tables& tables, const std::vector<std::string>& fields) {
  constexpr std::size_t kFirst = 2;
  if (fields.size() < kFirst + kDayKinds) return false;
  std::copy_n(fields.begin() + kFirst, kDayKinds, tables.weeks[fields[1]].begin());
  return true;
}

bool take_schedule(Tables& tables, const std::vector<std::string>& fields) {
  constexpr std::size_t kFirst = 3;
  std::vector<Span>& spans = tables.schedules[fields[1]];
  for (std::size_t i = kFirst; i + 1 < fields.size(); i += 2) {
    const auto span = span_of(fields[i], fields[i + 1]);
    if (!span) break;
    spans.push_back(*span);
  }
  return !spans.empty();
}

bool take(Tables& tables, const std::string& line) {
  const std::vector<std::string> fields = fields_of(line);
  if (fields[0] == "DaySchedule - Timestep") return take_day(tables, fields);
  if (fields[0] == "WeekSchedule - Timestep") return take_week(tables, fields);
  if (fields[0] == "Schedule - Timestep") return take_schedule(tables, fields);
  return true;
}

const std::string& week_on(const std::vector<Span>& spans, Day day) {
  const auto month = static_cast<unsigned>(day.month());
  const auto of_month = static_cast<unsigned>(day.day());
  for (const Span& span : spans) {
    if (std::pair(month, of_month) <= std::pair(span.last_month, span.last_day)) return span.week;
  }
  return spans.back().week;
}

}  // namespace

std::vector<Day> days_of(int year) {
  std::vector<Day> days;
  const sys_days end{std::chrono::year{year + 1} / 1 / 1};
  for (sys_days at{std::chrono::year{year} / 1 / 1}; at < end; at += std::chrono::days{1}) {
    days.emplace_back(at);
  }
  return days;
}

std::string in_capitals(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

Result<ScheduleYear> read_schedules(const std::filesystem::path& eio, int year,
                                    const std::vector<Day>& holidays) {
  std::ifstream file(eio);
  if (!file) return failure(ErrorCode::io_failed, fmt::format("cannot read {}", eio.string()));
  Tables tables;
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (!take(tables, line)) {
      return failure(ErrorCode::malformed,
                     fmt::format("{}, line {}: no schedule as EnergyPlus writes it: {}",
                                 eio.string(), number, line.substr(0, 80)));
    }
  }
  const std::set<sys_days> free(holidays.begin(), holidays.end());
  const std::vector<Day> days = days_of(year);
  ScheduleYear all;
  for (const auto& [name, spans] : tables.schedules) {
    Quarters& quarters = all[in_capitals(name)];
    quarters.reserve(days.size() * kQuartersPerDay);
    for (const Day day : days) {
      const auto& week = tables.weeks[week_on(spans, day)];
      const std::size_t kind = free.contains(sys_days{day})
                                   ? kHoliday
                                   : std::chrono::weekday{sys_days{day}}.c_encoding();
      const Quarters& values = tables.days[week[kind]];
      if (values.size() != kQuartersPerDay) {
        return failure(
            ErrorCode::malformed,
            fmt::format("{}: schedule {} refers to a day that is not there", eio.string(), name));
      }
      quarters.insert(quarters.end(), values.begin(), values.end());
    }
  }
  return all;
}

}  // namespace recald::simulators::energyplus
