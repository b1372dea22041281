/// What has been saved since a date: the months after it against what they would have used.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/assessment/output_assessment.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"
#include "core/metering/reading.hpp"
#include "core/result.hpp"
#include "core/savings/estimate.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"

namespace recald::daemon {

/// What one way of looking at it says of one meter.
struct AvoidedEnergy {
  double expected_kWh;            ///< In the months after, had nothing changed.
  savings::Estimate avoided_kWh;  ///< Expected minus measured.
  std::optional<savings::Estimate> money;
  std::optional<savings::Estimate> emissions_kg;
};

/// One month of a meter's, kWh/day.
struct MonthSince {
  metering::Month month;
  double measured;  ///< NaN: no usable figure, so that it does not count.
  std::optional<assessment::MonthForecast> regression;
  std::optional<assessment::MonthForecast> model;
};

struct MeterSince {
  std::string output;
  std::string meter;
  metering::Utility utility;
  int months;  ///< After the date, measured.
  double measured_kWh;
  /// IPMVP option C: a regression of the meter's days before on the outdoor temperature.
  std::optional<AvoidedEnergy> regression;
  /// IPMVP option D: the model, calibrated on the months before.
  std::optional<AvoidedEnergy> model;
  std::vector<MonthSince> since;
};

struct SavingsSince {
  metering::Day since;
  std::vector<std::string> before;          ///< Months learnt from.
  std::vector<std::string> after;           ///< Months looked at.
  std::optional<metering::Month> left_out;  ///< The date's, where it is neither.
  std::vector<MeterSince> meters;
  std::vector<std::string> notes;  ///< Sentences.
  display::Warnings warnings;      ///< Of the calibration.
};

/// The months before the date's to learn from, those after it to look at; a month that the date
/// parts is neither. They are those that any modelled meter has (all meters, without a model).
/// @return not_enough_data if there is no month on either side.
[[nodiscard]] Result<PeriodConfig> months_about(const OpenSite& site, const Recording& recording,
                                                metering::Instant now, metering::Day since);

/// @param finished  Of the period of `months_about`.
[[nodiscard]] SavingsSince savings_since(const FinishedCalibration& finished, metering::Day since);

/// Whether the two ways agree, as a sentence; empty where there is only one.
/// @param energy  Unit of display.
[[nodiscard]] std::string agreement_words(const MeterSince& meter, const display::Unit& energy);

}  // namespace recald::daemon
