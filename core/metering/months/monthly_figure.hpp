/// A meter's month as the figures that a building energy model is compared with.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/metering/reading.hpp"

namespace recald::metering {

/// Peak demand of a month. A filled or scaled slot is an average and never a peak.
struct PeakDemand {
  double kW;
  Instant start;
  bool could_be_exceeded;  ///< Some slots are not measured, so the true peak may be higher.
};

/// Daily-average consumption and peak demand of one local calendar month (the seed, section 2).
struct MonthlyFigure {
  Month month;
  double daily_average_kWh;  ///< Energy of the month / calendar days; NaN if nothing was measured.
  /// Variance of `daily_average_kWh` from estimated slots, (kWh/day)². Not the meter's own error.
  double daily_average_variance_kWh2;
  std::optional<PeakDemand> peak;
  std::chrono::seconds peak_window;
  double coverage;      ///< Share of the month's slots that are measured and valid, 0…1.
  double filled_share;  ///< Share of the slots that are filled or scaled.
  /// Of these, share of the slots whose values the source has estimated, as it says. Not kept in a
  /// store: only of months of files.
  double estimated_share = 0.0;
  std::array<int, 5> slots_by_validity;  ///< Indexed by `Validity`.
  int slots;                             ///< Slots of the local month, clock changes included.
  bool usable;                           ///< May be used for calibration.
  std::string unusable_because;          ///< Empty when usable.
  Reason reasons = Reason::none;         ///< Union over the month's slots.
  int revision = 0;                      ///< Number of re-openings by late readings.
};

}  // namespace recald::metering
