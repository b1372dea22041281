/// A run's meters as the monthly figures that an engine gives, and as its days.
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "adapters/energyplus/run/meter_output.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

/// A meter that an output is made of.
struct SignedMeter {
  std::string name;  ///< As EnergyPlus calls it.
  double sign = 1.0;
};

/// One output of the engine: a sum of reported meters.
struct ModelOutput {
  std::string name;  ///< For messages.
  std::vector<SignedMeter> meters;
  bool is_peak = false;  ///< The month's largest mean over the window, in kW; else kWh/day.
  double interval_noise =
      0.0;  ///< Of peaks: relative sd of the meter's intervals about the model's.
};

/// Splits "Electricity:Facility" or "-Cooling:Electricity" into a name and a sign.
[[nodiscard]] SignedMeter parse_signed_meter(std::string_view text);

/// The meters that a list of outputs needs, each once.
[[nodiscard]] std::vector<std::string> meters_of(std::span<const ModelOutput> outputs);

/// @param meters  What a run reported, in the order of `meters_of(outputs)`.
/// @param months  Local calendar months.
/// @param window  Of peaks.
/// @return (outputs * months) output-major; NaN for a month that the run does not cover whole.
[[nodiscard]] std::vector<double> monthly_figures(std::span<const MeterOutput> meters,
                                                  std::span<const ModelOutput> outputs,
                                                  std::span<const metering::Month> months,
                                                  const metering::LocalCalendar& calendar,
                                                  std::chrono::seconds window);

/// @param days  Local calendar days.
/// @return (outputs * days) output-major: the day's energy in kWh, of a peak the day's largest mean
///         over the window in kW; NaN for a day that the run does not cover whole.
[[nodiscard]] std::vector<double> daily_figures(std::span<const MeterOutput> meters,
                                                std::span<const ModelOutput> outputs,
                                                std::span<const metering::Day> days,
                                                const metering::LocalCalendar& calendar,
                                                std::chrono::seconds window);

}  // namespace recald::energyplus
