/// What a year of quarter hours looks like: mean days by local hour, sums by local month.
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
enum class PartOfWeek { working_days, weekend };  ///< Monday to Friday; holidays are not looked up.

struct DayGroup {
  HalfYear half_year;
  PartOfWeek part_of_week;
  std::optional<metering::Day> from;  ///< Absent: from the beginning.
  std::optional<metering::Day> to;    ///< Last day; absent: to the end.

  [[nodiscard]] bool contains(metering::Day day) const;
};

using MeanDay = std::array<double, 24>;  ///< By the hour on the local clock.
using MonthlySum = std::array<double, 12>;

/// The mean in each local hour over the days of the group. Where the clock skips an hour that day
/// says nothing of it; where the clock repeats one, that day counts twice in it.
/// @return nothing if the series holds no such day
[[nodiscard]] std::optional<MeanDay> mean_day(const IntervalSeries& series, const DayGroup& group,
                                              const metering::LocalCalendar& calendar);

/// kWh by calendar month of the local clock, January first; those of several years are added up.
/// @param series_kW  mean powers
[[nodiscard]] MonthlySum monthly_kWh(const IntervalSeries& series_kW,
                                     const metering::LocalCalendar& calendar);

/// The means of hour after hour, from the local midnight that begins `first` to that which ends the
/// last of `days`.
/// @pre the series holds these days
[[nodiscard]] std::vector<double> hourly_means(const IntervalSeries& series, metering::Day first,
                                               int days, const metering::LocalCalendar& calendar);

}  // namespace recald::simulators
