#include "simulators/building/campus_calendar.hpp"

#include <algorithm>

namespace recald::simulators {
namespace {

using std::chrono::sys_days;
using std::chrono::weekday;

metering::Day observed(metering::Day day) {
  const weekday when{sys_days{day}};
  if (when == std::chrono::Saturday) return sys_days{day} - std::chrono::days{1};
  if (when == std::chrono::Sunday) return sys_days{day} + std::chrono::days{1};
  return day;
}

}  // namespace

std::vector<metering::Day> holidays_of(std::chrono::year year) {
  using namespace std::chrono;
  const metering::Day thanksgiving{sys_days{year / November / Thursday[4]}};
  const metering::Day new_year{year / January / 1};
  std::vector<metering::Day> days{
      // A New Year's Day on a Saturday is not observed on the Friday, which is another year's.
      weekday{sys_days{new_year}} == Saturday ? new_year : observed(new_year),
      sys_days{year / January / Monday[3]},
      sys_days{year / May / Monday[last]},
      observed(year / July / 4),
      sys_days{year / September / Monday[1]},
      thanksgiving,
      sys_days{thanksgiving} + std::chrono::days{1},
      year / December / 24,
      year / December / 25,
  };
  const weekday christmas{sys_days{year / December / 25}};
  if (christmas == Sunday) days.push_back(year / December / 26);
  if (christmas == Saturday) days.push_back(year / December / 27);
  std::ranges::sort(days);
  return days;
}

DayKind day_kind(metering::Day day) {
  const auto holidays = holidays_of(day.year());
  if (std::ranges::find(holidays, day) != holidays.end()) return DayKind::sunday;
  const weekday when{sys_days{day}};
  if (when == std::chrono::Sunday) return DayKind::sunday;
  return when == std::chrono::Saturday ? DayKind::saturday : DayKind::workday;
}

double season_attendance(metering::Day day) {
  using namespace std::chrono;
  const unsigned month = static_cast<unsigned>(day.month());
  const unsigned date = static_cast<unsigned>(day.day());
  if ((month == 12 && date >= 19) || (month == 1 && date <= 4)) return 0.50;
  if (month == 3 && date >= 14 && date <= 20) return 0.88;  // spring break
  if (month == 6 || month == 7 || (month == 8 && date <= 15)) return 0.93;
  return 1.0;
}

}  // namespace recald::simulators
