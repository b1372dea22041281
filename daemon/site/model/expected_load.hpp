/// What a model expects meters to read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/profile/load_band.hpp"

namespace recald::daemon {

struct ExpectedHour {
  metering::Instant start;
  profile::ExpectedLoad load;
};

/// The month that goes on: its mean is what the meter reads until `rest_from` and `rest_kW` after
/// it, and off by an error that is a share of the forecast (month_hindcast.hpp).
struct ExpectedMonth {
  metering::Month month;
  metering::Instant rest_from;
  double rest_kW;  ///< Mean of the hours from there on.
  double mean_kW;  ///< Of the meter, over its closed months.
  double error_q05;
  double error_q50;
  double error_q95;
};

struct ExpectedMeter {
  std::string meter;                        ///< Its id, one of the model's outputs.
  std::vector<ExpectedHour> hours;          ///< In order of time; one without a band is left out.
  std::optional<ExpectedMonth> month = {};  ///< Absent: fewer than seven closed months.
};

}  // namespace recald::daemon
