/// A meter's days and their temperatures, as regressions take them.
#pragma once

#include <map>
#include <vector>

#include "core/change_point/meter_day.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"

namespace recald::daemon {

/// Mean outdoor temperature of every local day of these months; NaN where too few of its hours have
/// one.
[[nodiscard]] std::map<metering::Day, double> daily_dry_bulbs_C(
    const metering::LocalCalendar& calendar, const SiteWeather& weather,
    const std::vector<metering::Month>& months);

/// Mean power of a day's valid hours over a whole day. Days that have lost too many hours are left
/// out.
[[nodiscard]] std::map<metering::Day, double> daily_energies_kWh(const MeterRecord& record);

/// Every day of the result's months with this role, ascending. A month without a usable figure
/// teaches nothing.
[[nodiscard]] std::vector<change_point::MeterDay> meter_days(
    const model::Holidays& holidays, const SiteCalibration& result,
    const assessment::OutputCalibration& output, assessment::MonthRole role,
    const std::map<metering::Day, double>& temperatures,
    const std::map<metering::Day, double>& energies);

}  // namespace recald::daemon
