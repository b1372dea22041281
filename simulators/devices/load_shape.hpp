/// The load of a simulated meter over time: steps of constant power, so that its energy is exact.
#pragma once

#include <chrono>
#include <vector>

#include "core/metering/registers/trial_clock.hpp"

namespace recald::simulators {

using SimulatedTime = metering::TrialClock::Milliseconds;  ///< UTC.

class LoadShape {
 public:
  [[nodiscard]] static LoadShape constant(double kW);
  /// Repeats every day. @param hours_kW  24 means from 00:00 UTC on.
  [[nodiscard]] static LoadShape daily(std::vector<double> hours_kW);
  /// Runs once, with no load before and after. @param kW  Mean of each step, one or more.
  [[nodiscard]] static LoadShape recorded(metering::Instant begin, std::chrono::seconds step,
                                          std::vector<double> kW);

  [[nodiscard]] double power_kW(SimulatedTime t) const;
  /// The integral of the power, negative if `to` is earlier.
  [[nodiscard]] double energy_kWh(SimulatedTime from, SimulatedTime to) const {
    return counted_kWh(to) - counted_kWh(from);
  }

 private:
  /// A moment as full cycles of the shape, a step in it, and the time since that step began.
  struct Place {
    std::int64_t rounds;
    std::size_t step;  ///< power_kW_.size() after the end.
    std::chrono::milliseconds since;
  };

  LoadShape(SimulatedTime begin, std::chrono::milliseconds step, std::vector<double> kW,
            bool repeats);
  [[nodiscard]] Place place(SimulatedTime t) const;
  [[nodiscard]] double counted_kWh(SimulatedTime t) const;

  SimulatedTime begin_;
  std::chrono::milliseconds step_;
  std::vector<double> power_kW_;
  std::vector<double> before_kWh_;  ///< Energy of all steps before each one, and finally of all.
  bool repeats_;
};

}  // namespace recald::simulators
