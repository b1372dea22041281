/// Forms intervals on the grid from samples of power, for meters without a counter.
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
  /// Between samples further apart, power counts as unmeasured. Usually two poll periods.
  std::chrono::seconds sample_gap_max{30};
  double coverage_min = 0.8;           ///< Least measured share of an interval.
  std::chrono::seconds hole_max{300};  ///< Longest unmeasured stretch inside an interval.
};

/// The open interval. A plain value that must survive a restart.
struct PowerBook {
  std::optional<Instant> next;     ///< Start of the first interval not yet completed.
  Instant until{};                 ///< The time before it is accounted for.
  std::optional<double> power_kW;  ///< At `until`; absent: unknown there.
  double energy_kWh = 0.0;         ///< Of the measured part of the open interval.
  std::chrono::seconds covered{0};
  std::chrono::seconds hole_longest{0};
  Reason reasons = Reason::none;  ///< Why there are holes.
};

/// Enters one sample and returns the intervals that it completes, in order of time.
///
/// An interval's value is the mean over its measured time, with the power running straight from
/// sample to sample. It is `ok` if that time covers `coverage_min` of it and no hole is longer
/// than `hole_max`. Otherwise it is missing, reason `partial`: without a counter the load in
/// the hole is unknown. Samples that are not later than the last one are ignored, so no
/// interval is returned twice.
///
/// @param reasons  Why reads failed since the previous sample; kept if that left a hole.
/// @pre sample.power_kW is finite, interval divides a day.
[[nodiscard]] std::vector<Reading> book_power(PowerBook& book, std::uint32_t meter,
                                              const PowerSample& sample, Reason reasons,
                                              const PowerRules& rules);

/// The load since the last sample is unknown (the clock was set).
void forget_power(PowerBook& book);

}  // namespace recald::metering
