/// Measured weather as an EnergyPlus weather file.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"
#include "core/weather/sun.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::epw {

/// The text of an EPW file of one calendar year, in the zone's standard time: leap day, weekdays,
/// summer time and holidays are those of the year. Of the hours' means temperature, humidity, wind
/// and pressure become values at the end of the hour, as the format wants them; irradiance stays
/// the hour's. Sun that was recorded as global only is split by the clearness of the sky. Pressure
/// that nobody measured is that of the altitude, and the sky's infrared radiation is left for
/// EnergyPlus to work out.
///
/// @param place  Stands in the header.
/// @return not_enough_data naming the first hour of the year without temperature, humidity, wind
///         or sun.
/// @see EnergyPlus, Auxiliary Programs, "EnergyPlus Weather File (EPW) Data Dictionary".
[[nodiscard]] Result<std::string> epw_text(const weather::WeatherSeries& weather, int year,
                                           const weather::Location& location,
                                           const metering::LocalCalendar& calendar,
                                           const std::set<metering::Day>& holidays,
                                           std::string_view place);

}  // namespace recald::epw
