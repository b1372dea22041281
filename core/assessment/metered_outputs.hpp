/// A meter's months as outputs of a model: which figures may be calibrated against.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/assessment/assessed_calibration.hpp"
#include "core/metering/months/level_change.hpp"
#include "core/metering/months/monthly_figure.hpp"

namespace recald::assessment {

/// What is known of one meter.
struct MeteredMonths {
  const std::string& id;
  std::size_t meter;  ///< Index into the recording.
  metering::Utility utility;
  std::span<const metering::MonthlyFigure> figures;
  std::span<const metering::LevelChange> changes;
};

/// Daily averages. A month without a usable figure is not measured, nor is one that the meter
/// counts in another unit.
[[nodiscard]] OutputCalibration daily_output(const MeteredMonths& metered,
                                             const std::vector<metering::Month>& months);

/// Peaks of the same months.
[[nodiscard]] OutputCalibration peak_output(const MeteredMonths& metered,
                                            const std::vector<metering::Month>& months);

}  // namespace recald::assessment
