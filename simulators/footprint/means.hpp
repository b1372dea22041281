/// Summaries of a year of quarter hours: mean days by local hour, sums by local month.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::simulators {

/// Means over intervals of `kInterval`, gapless from `begin`, in any unit.
struct IntervalSeries {
  metering::Instant begin;
  std::span<const double> means;
};

enum class HalfYear { winter, summer };           ///< October to March, April to September.
enum class PartOfWeek { working_days, weekend };  ///< Monday to Friday; holidays are ignored.

struct DayGroup {
  HalfYear half_year;
  PartOfWeek part_of_week;
  std::optional<metering::Day> from;  ///< Absent: from the beginning.
  std::optional<metering::Day> to;    ///< Last day; absent: to the end.

  [[nodiscard]] bool contains(metering::Day day) const;
};

using MeanDay = std::array<double, 24>;  ///< By the hour on the local clock.
using MonthlySum = std::array<double, 12>;

/// The mean in each local hour over the days of the group. A day on which the clock skips an hour
/// does not count in that hour; a day on which it repeats one counts twice.
/// @return nothing if the series holds no such day
[[nodiscard]] std::optional<MeanDay> mean_day(const IntervalSeries& series, const DayGroup& group,
                                              const metering::LocalCalendar& calendar);

/// kWh by calendar month in local time, January first; several years are added up.
/// @param series_kW  Mean powers.
[[nodiscard]] MonthlySum monthly_kWh(const IntervalSeries& series_kW,
                                     const metering::LocalCalendar& calendar);

/// Hourly means from the local midnight at the start of `first` to the end of the last of `days`.
/// @pre the series holds these days
[[nodiscard]] std::vector<double> hourly_means(const IntervalSeries& series, metering::Day first,
                                               int days, const metering::LocalCalendar& calendar);

}  // namespace recald::simulators
