/// Prepares an EPC for calibration from a site's description, weather and electricity record.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/model/building.hpp"
#include "core/model/electricity_profile.hpp"
#include "core/model/epc/climate_classes.hpp"
#include "core/model/epc/epc_model.hpp"
#include "core/result.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::model::epc {

/// What the model needs to know about the place; references live as long as the call.
struct Place {
  const metering::LocalCalendar& calendar;
  const Holidays& holidays;
  weather::Location location;
  const weather::WeatherSeries& weather;
};

/// Fits the electricity profile with the fans and pumps that the EPC itself expects at its design
/// values, so that the model adds back exactly what the profile leaves out. Fans depend on loads
/// and loads on fans: two rounds converge to well below one per cent.
/// @param months  The months of the loads; the weather must cover them.
[[nodiscard]] Result<model::ElectricityProfile> fit_profile_with_fans(
    std::span<const model::HourlyLoad> loads, const Building& building, const Place& place,
    const std::vector<metering::Month>& months);

/// The classes of a period, shared by all copies of a model.
[[nodiscard]] Result<std::shared_ptr<const ClimateClasses>> prepare_climate(
    const std::vector<metering::Month>& months, const Building& building,
    const ElectricLoads& loads, const Place& place);

}  // namespace recald::model::epc
