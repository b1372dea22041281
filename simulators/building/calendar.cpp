#include "simulators/building/calendar.hpp"

#include <algorithm>

namespace recald::simulators {
namespace {

using metering::Day;
using std::chrono::days;
using std::chrono::sys_days;
using std::chrono::weekday;
using std::chrono::year;

Day observed(Day day) {
  const weekday when{sys_days{day}};
  if (when == std::chrono::Saturday) return sys_days{day} - days{1};
  if (when == std::chrono::Sunday) return sys_days{day} + days{1};
  return day;
}

/// Inclusive; also weekends, which are free anyway.
void add_span(std::vector<Day>& list, Day first, Day last) {
  for (sys_days day{first}; day <= sys_days{last}; day += days{1}) list.emplace_back(day);
}

std::vector<Day> public_holidays(year y) {
  using namespace std::chrono;
  const Day thanksgiving{sys_days{y / November / Thursday[4]}};
  const Day new_year{y / January / 1};
  return {
      // A New Year's Day on a Saturday is not observed on the Friday, which belongs
      // to another year.
      weekday{sys_days{new_year}} == Saturday ? new_year : observed(new_year),
      sys_days{y / January / Monday[3]},
      sys_days{y / May / Monday[last]},
      observed(y / July / 4),
      sys_days{y / September / Monday[1]},
      thanksgiving,
      sys_days{thanksgiving} + days{1},
  };
}

void add_campus_days(std::vector<Day>& list, year y) {
  using namespace std::chrono;
  list.push_back(y / December / 24);
  list.push_back(y / December / 25);
  const weekday christmas{sys_days{y / December / 25}};
  if (christmas == Sunday) list.push_back(y / December / 26);
  if (christmas == Saturday) list.push_back(y / December / 27);
}

void add_office_days(std::vector<Day>& list, year y) {
  using namespace std::chrono;
  list.push_back(sys_days{y / February / Monday[3]});
  list.push_back(observed(y / December / 25));
}

void add_school_breaks(std::vector<Day>& list, year y) {
  using namespace std::chrono;
  list.push_back(sys_days{y / February / Monday[3]});
  add_span(list, y / January / 1, y / January / 3);
  const sys_days spring{y / April / Monday[1]};
  add_span(list, spring, spring + days{4});
  add_span(list, y / June / 15, y / August / 20);
  add_span(list, y / December / 21, y / December / 31);
}

/// Shops open on most holidays; these are the days on which they close.
std::vector<Day> trading_holidays(year y) {
  using namespace std::chrono;
  return {y / January / 1, sys_days{y / November / Thursday[4]}, y / December / 25};
}

void add_mondays(std::vector<Day>& list, year y) {
  using namespace std::chrono;
  for (sys_days day{y / January / Monday[1]}; year_month_day{day}.year() == y; day += weeks{1}) {
    list.emplace_back(day);
  }
}

std::vector<Day> all_holidays(Use use, year y) {
  using namespace std::chrono;
  std::vector<Day> list;
  switch (use) {
    case Use::laboratory:
      list = public_holidays(y);
      add_campus_days(list, y);
      break;
    case Use::office:
      list = public_holidays(y);
      add_office_days(list, y);
      break;
    case Use::school:
      list = public_holidays(y);
      add_school_breaks(list, y);
      break;
    case Use::clinic:
    case Use::warehouse:
      list = public_holidays(y);
      list.push_back(observed(y / December / 25));
      break;
    case Use::shop:
      list = trading_holidays(y);
      list.push_back(y / July / 4);
      break;
    case Use::restaurant:
      list = trading_holidays(y);
      add_mondays(list, y);
      break;
    case Use::gym:
      list = trading_holidays(y);
      break;
    case Use::hotel:
      break;
  }
  return list;
}

}  // namespace

bool is_open(OpenDays days, DayKind kind) {
  switch (kind) {
    case DayKind::workday:
      return true;
    case DayKind::saturday:
      return days != OpenDays::workdays;
    case DayKind::sunday:
      return days == OpenDays::every_day;
  }
  return false;
}

std::vector<Day> Calendar::holidays_of(year y) const {
  std::vector<Day> list = all_holidays(use_, y);
  std::ranges::sort(list);
  const auto twice = std::ranges::unique(list);
  list.erase(twice.begin(), twice.end());
  return list;
}

DayKind Calendar::kind_of(Day day) const {
  const auto holidays = holidays_of(day.year());
  if (std::ranges::find(holidays, day) != holidays.end()) return DayKind::sunday;
  const weekday when{sys_days{day}};
  if (when == std::chrono::Sunday) return DayKind::sunday;
  return when == std::chrono::Saturday ? DayKind::saturday : DayKind::workday;
}

double Calendar::season_attendance(Day day) const {
  if (use_ != Use::laboratory && use_ != Use::office) return 1.0;  // breaks are holidays
  const auto month = static_cast<unsigned>(day.month());
  const auto date = static_cast<unsigned>(day.day());
  if ((month == 12 && date >= 19) || (month == 1 && date <= 4)) return 0.50;
  const bool campus = use_ == Use::laboratory;
  if (campus && month == 3 && date >= 14 && date <= 20) return 0.88;  // spring break
  if (month == 6 || month == 7 || (month == 8 && date <= 15)) return campus ? 0.93 : 0.90;
  return 1.0;
}

}  // namespace recald::simulators
