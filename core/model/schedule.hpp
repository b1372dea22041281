/// Kinds of day, and hourly values for each.
#pragma once

#include <array>
#include <cstddef>
#include <set>

#include "core/metering/civil_time.hpp"

namespace recald::model {

/// Holidays run like Sundays: in the meters of real buildings they are nearly the same.
enum class DayType : std::size_t { workday, saturday, sunday_or_holiday };
inline constexpr std::size_t kDayTypes = 3;
inline constexpr std::array<const char*, kDayTypes> kDayTypeNames = {"workday", "saturday",
                                                                     "sunday_or_holiday"};

using Holidays = std::set<metering::Day>;

[[nodiscard]] inline DayType day_type(metering::Day day, const Holidays& holidays) {
  const std::chrono::weekday weekday{std::chrono::sys_days{day}};
  if (holidays.contains(day) || weekday == std::chrono::Sunday) return DayType::sunday_or_holiday;
  return weekday == std::chrono::Saturday ? DayType::saturday : DayType::workday;
}

/// A value for each local hour 0…23 of each kind of day.
class HourlySchedule {
 public:
  double& at(DayType day, int hour) { return values_[index(day)][static_cast<std::size_t>(hour)]; }
  [[nodiscard]] double at(DayType day, int hour) const {
    return values_[index(day)][static_cast<std::size_t>(hour)];
  }

  bool operator==(const HourlySchedule&) const = default;

 private:
  static std::size_t index(DayType day) { return static_cast<std::size_t>(day); }
  std::array<std::array<double, 24>, kDayTypes> values_{};
};

}  // namespace recald::model
