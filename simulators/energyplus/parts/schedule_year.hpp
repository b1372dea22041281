/// The schedules of a model, quarter hour by quarter hour of one calendar year.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::simulators::energyplus {

inline constexpr std::size_t kQuartersPerDay = 96;

/// By quarter hour of local clock time, whole days.
using Quarters = std::vector<double>;

/// By name, in capitals as EnergyPlus writes them.
using ScheduleYear = std::map<std::string, Quarters>;

/// All days of a year, in order.
[[nodiscard]] std::vector<metering::Day> days_of(int year);

[[nodiscard]] std::string in_capitals(std::string text);

/// What EnergyPlus understood of a model's schedules.
/// @param eio  `eplusout.eio` of a run with Output:Schedules, Timestep, at quarter hours.
/// @return io_failed: there is no such file; malformed: a line that is none of EnergyPlus's.
[[nodiscard]] Result<ScheduleYear> read_schedules(const std::filesystem::path& eio, int year,
                                                  const std::vector<metering::Day>& holidays);

}  // namespace recald::simulators::energyplus
