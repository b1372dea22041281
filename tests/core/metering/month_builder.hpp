/// Months for tests, as a source would have delivered them.
#pragma once

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/metering/months/month_slots.hpp"

namespace recald::metering::testing {

inline constexpr double kBlank = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::chrono::seconds kQuarter{900};
inline constexpr std::chrono::seconds kHour{3600};

inline LocalCalendar calendar(const std::string& zone) {
  auto opened = LocalCalendar::open(zone);
  if (!opened) throw std::runtime_error(opened.error().message);
  return *opened;
}

inline Month month(int year, unsigned number) {
  return std::chrono::year{year} / std::chrono::month{number};
}

inline Instant utc(int year, unsigned number, unsigned day, int hour = 0, int minute = 0) {
  return Instant{std::chrono::sys_days{month(year, number) / std::chrono::day{day}}} +
         std::chrono::hours{hour} + std::chrono::minutes{minute};
}

/// Every slot reads `value(slot)` kW; NaN is a blank.
template <class Value>
MonthSlots month_reading(const std::string& zone, Month which, std::chrono::seconds interval,
                         Value value) {
  MonthSlots slots{
      std::make_shared<const MonthGrid>(calendar(zone), which, interval, std::chrono::seconds{0})};
  for (int slot = 0; slot < slots.slots(); ++slot) {
    const double value_kW = value(slot);
    if (std::isnan(value_kW)) continue;
    slots.measured_kW[static_cast<std::size_t>(slot)] = value_kW;
    slots.validity[static_cast<std::size_t>(slot)] = Validity::ok;
  }
  return slots;
}

}  // namespace recald::metering::testing
