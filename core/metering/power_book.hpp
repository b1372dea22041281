/// From samples of a power to intervals on the grid, for meters that count nothing.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/metering/reading.hpp"

namespace recald::metering {

struct PowerSample {
  Instant time;
  double power_kW;  ///< Finite.
};

struct PowerRules {
  std::chrono::seconds interval{900};
  /// Samples further apart leave what lies between them unmeasured. Usually two poll periods.
  std::chrono::seconds sample_gap_max{30};
  double coverage_min = 0.8;           ///< Of an interval that is measured, at least.
  std::chrono::seconds hole_max{300};  ///< Longest unmeasured stretch inside an interval.
};

/// The interval that is open. A plain value that must survive a restart.
struct PowerBook {
  std::optional<Instant> next;     ///< Start of the first interval not handed out.
  Instant until{};                 ///< What came before is accounted for.
  std::optional<double> power_kW;  ///< At `until`; none: not known there.
  double energy_kWh = 0.0;         ///< Of the measured part of the open interval.
  std::chrono::seconds covered{0};
  std::chrono::seconds hole_longest{0};
  Reason reasons = Reason::none;  ///< Why there are holes.
};

/// Enters one sample and hands out the intervals that it completes, in order of time.
///
/// An interval's value is the mean over its measured time, the power running straight from sample
/// to sample. It is `ok` where that time covers `coverage_min` of it and no hole is longer than
/// `hole_max`; else it is missing, reason `partial`: without a counter nothing says what the load
/// did meanwhile. Samples that are not later than the last one are left out, so no interval is
/// handed out twice.
///
/// @param reasons  Why reads failed since the sample before; kept where that left a hole.
/// @pre sample.power_kW is finite, interval divides a day.
[[nodiscard]] std::vector<Reading> book_power(PowerBook& book, std::uint32_t meter,
                                              const PowerSample& sample, Reason reasons,
                                              const PowerRules& rules);

/// What the load did since the last sample is not known (the clock was set).
void forget_power(PowerBook& book);

}  // namespace recald::metering
