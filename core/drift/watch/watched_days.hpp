/// A meter's days, beside what an hourly model makes of them.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "core/drift/watch/daily_reference.hpp"
#include "core/metering/civil_time.hpp"
#include "core/model/drivers.hpp"

namespace recald::drift {

/// Every day of the followed months, its energies left out.
struct DayFrame {
  std::vector<WatchedDay> days;
  std::vector<int> day_of_hour;  ///< (hours) Index into days; -1: of no followed month.
};

/// @param months  "2019-03", ascending; days of others are left out.
[[nodiscard]] DayFrame frame_of(const model::Drivers& drivers,
                                const std::vector<std::string>& months);

/// One meter's days in order of time. A day that lacks hours is not measured.
/// @param followed     (months) NaN: none, and its days are none either.
/// @param measured_kW  (hours of the drivers) NaN: none.
/// @param modelled_kW  (hours of the drivers)
[[nodiscard]] std::vector<WatchedDay> days_of(const DayFrame& frame,
                                              std::span<const double> followed,
                                              const Eigen::Ref<const Eigen::ArrayXd>& measured_kW,
                                              const Eigen::Ref<const Eigen::ArrayXd>& modelled_kW);

}  // namespace recald::drift
