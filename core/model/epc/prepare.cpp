#include "core/model/epc/prepare.hpp"

#include <cmath>
#include <utility>

namespace recald::model::epc {
namespace {

/// Fan and pump power by kind of day and hour with the yearly energy that the EPC expects; at
/// night, for the share of the air handlers that runs.
HourlySchedule spread_fans_and_pumps(const Building& building, const Drivers& drivers,
                                     double energy_kWh) {
  HourlySchedule schedule;
  const double night_share = building.air->outdoor_air_unoccupied_fraction;
  double weighted_hours = 0.0;
  for (const DriverHour& hour : drivers.hours) weighted_hours += hour.occupied ? 1.0 : night_share;
  const double day_kW = energy_kWh / weighted_hours;
  for (std::size_t i = 0; i < kDayTypes; ++i) {
    const auto day = static_cast<DayType>(i);
    for (int hour = 0; hour < 24; ++hour) {
      schedule.at(day, hour) =
          day_kW * (is_occupied(building.set_points, day, hour) ? 1.0 : night_share);
    }
  }
  return schedule;
}

}  // namespace

Result<model::ElectricityProfile> fit_profile_with_fans(
    std::span<const model::HourlyLoad> loads, const Building& building, const Place& place,
    const std::vector<metering::Month>& months) {
  model::KnownLoads known{.exterior_kW = building.use.exterior_kW,
                          .fans_and_pumps_kW = {},
                          .lighting_W_m2 = building.use.lighting_W_m2,
                          .plugs_W_m2 = building.use.plugs_W_m2};
  auto profile = model::fit_profile(loads, place.holidays, known);
  if (!profile || !building.air) return profile;
  for (int round = 0; round < 2; ++round) {
    const auto drivers = TRY(make_drivers(months, place.calendar, place.holidays, building,
                                          profile->loads, place.location, place.weather));
    Epc epc{
        std::make_shared<const ClimateClasses>(make_climate_classes(drivers, kClassesPerState))};
    std::vector<EndUseEnergy> energy(months.size());
    epc.evaluate(building, energy);
    double fans_and_pumps_kWh = 0.0;
    for (const EndUseEnergy& month : energy) {
      fans_and_pumps_kWh += month[EndUse::fans] + month[EndUse::pumps];
    }
    known.fans_and_pumps_kW = spread_fans_and_pumps(building, drivers, fans_and_pumps_kWh);
    profile = model::fit_profile(loads, place.holidays, known);
    if (!profile) return profile;
  }
  return profile;
}

Result<std::shared_ptr<const ClimateClasses>> prepare_climate(
    const std::vector<metering::Month>& months, const Building& building,
    const ElectricLoads& loads, const Place& place) {
  const auto drivers = TRY(make_drivers(months, place.calendar, place.holidays, building, loads,
                                        place.location, place.weather));
  return std::make_shared<const ClimateClasses>(make_climate_classes(drivers, kClassesPerState));
}

}  // namespace recald::model::epc
