#include "core/diagnosis/effects/support/public_holidays.hpp"

#include <chrono>

namespace recald::diagnosis {
namespace {

using metering::Day;

/// A holiday on a weekend is observed on the nearest weekday.
Day observed(std::chrono::sys_days day) {
  const std::chrono::weekday weekday{day};
  if (weekday == std::chrono::Saturday) return day - std::chrono::days{1};
  if (weekday == std::chrono::Sunday) return day + std::chrono::days{1};
  return day;
}

void mark_year_end(std::chrono::year year, DateTable& table) {
  table.mark(year / 12 / 24, year / 12 / 26);
  table.mark(year / 12 / 31);
}

/// Days on which most offices in the United States are closed.
DateTable north_american_holidays() {
  using namespace std::chrono;  // NOLINT: calendar literals
  DateTable table;
  for (int y = DateTable::kFirstYear; y <= DateTable::kLastYear; ++y) {
    const year year{y};
    const sys_days thanksgiving = sys_days{year / November / Thursday[4]};
    table.mark(observed(year / January / 1));
    table.mark(sys_days{year / January / Monday[3]});
    table.mark(sys_days{year / May / Monday[last]});
    table.mark(observed(year / July / 4));
    table.mark(sys_days{year / September / Monday[1]});
    table.mark(thanksgiving, thanksgiving + days{1});
    table.mark(observed(year / December / 25));
    mark_year_end(year, table);
  }
  return table;
}

/// Days common to most countries of Western and Central Europe; not moved from weekends.
DateTable european_holidays() {
  using namespace std::chrono;  // NOLINT: calendar literals
  DateTable table;
  for (int y = DateTable::kFirstYear; y <= DateTable::kLastYear; ++y) {
    const year year{y};
    const sys_days easter = easter_sunday(year);
    table.mark(year / January / 1);
    table.mark(easter - days{2});   // Good Friday
    table.mark(easter + days{1});   // Easter Monday
    table.mark(easter + days{39});  // Ascension
    table.mark(easter + days{50});  // Whit Monday
    table.mark(year / May / 1);
    mark_year_end(year, table);
  }
  return table;
}

/// A British holiday on a weekend moves to the next working day.
Day made_up(std::chrono::sys_days day) {
  const std::chrono::weekday weekday{day};
  if (weekday == std::chrono::Saturday) return day + std::chrono::days{2};
  if (weekday == std::chrono::Sunday) return day + std::chrono::days{1};
  return day;
}

/// Bank holidays of England and Wales, and the days to New Year, when most offices are closed.
DateTable british_holidays() {
  using namespace std::chrono;  // NOLINT: calendar literals
  DateTable table;
  for (int y = DateTable::kFirstYear; y <= DateTable::kLastYear; ++y) {
    const year year{y};
    const sys_days easter = easter_sunday(year);
    table.mark(made_up(year / January / 1));
    table.mark(easter - days{2});  // Good Friday
    table.mark(easter + days{1});  // Easter Monday
    table.mark(sys_days{year / May / Monday[1]});
    table.mark(sys_days{year / May / Monday[last]});
    table.mark(sys_days{year / August / Monday[last]});
    table.mark(year / 12 / 24, year / 12 / 31);
  }
  return table;
}

}  // namespace

const DateTable& public_holidays(std::size_t calendar) {
  static const std::array<DateTable, kHolidayCalendars.size()> tables{
      north_american_holidays(), european_holidays(), british_holidays()};
  return tables[calendar];
}

}  // namespace recald::diagnosis
