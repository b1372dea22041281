#include <fmt/format.h>

#include "simulators/building/campus_calendar.hpp"
#include "simulators/feed/feed_files.hpp"

namespace recald::simulators {
namespace {

using namespace drawings;

std::string holiday_list(const Period& period) {
  std::string list;
  for (int year = period.start_year; year < period.start_year + period.years; ++year) {
    for (const metering::Day day : holidays_of(std::chrono::year{year})) {
      list += fmt::format("  \"{}\",\n", metering::to_string(day));
    }
  }
  return list;
}

std::string heading(const Period& period) {
  return fmt::format(
      R"(# Campus laboratory building: three storeys, offices around a laboratory core, six air handlers
# (variable air volume, reheat), chilled water and steam from the district, electricity from the
# utility. Numbers are those of drawings and nameplates.

[site]
id = "campus-lab"
name = "Campus laboratory building"
timezone = "{}"
latitude_deg = {}
longitude_deg = {}
altitude_m = {}
interval = "15m"
holidays = [   # local dates that run like Sundays
{}]

[weather]
file = "weather.csv"
format = "csv"
stamps = "start"

)",
      time_zone, place.latitude_deg, place.longitude_deg, place.altitude_m, holiday_list(period));
}

std::string meters() {
  return R"([[meter]]
id = "electricity"
utility = "electricity"
file = "readings.csv"
stamps = "start"
rated_kW = 900

[[meter]]
id = "chilled_water"
utility = "chilled_water"
file = "readings.csv"
stamps = "start"
rated_kW = 2500

[[meter]]
id = "steam"
utility = "steam"
file = "readings.csv"
stamps = "start"
rated_kW = 2000
zero_run_max = "6h"   # longest believable run of exact zeros
stuck_max = "3h"

)";
}

/// The last year validates; a single year keeps its last four months for that.
std::string periods_and_model(const Period& period) {
  const int last_year = period.start_year + period.years - 1;
  const bool single = period.years == 1;
  const std::string calibration_end =
      single ? fmt::format("{}-08", last_year) : fmt::format("{}-12", last_year - 1);
  return fmt::format(R"([period]
calibration = {{ from = "{}-01", to = "{}" }}
validation = {{ from = "{}-{}", to = "{}-12" }}

[[model]]
kind = "epc"
outputs = ["electricity", "chilled_water", "steam"]
weights = {{ steam = 0.5 }}   # the steam meter is known to be poor

)",
                     period.start_year, calibration_end, last_year, single ? "09" : "01",
                     last_year);
}

std::string surface(std::string_view name, std::string_view kind, double area_m2, double u_W_m2K,
                    std::string_view rest) {
  return fmt::format(
      "[[building.surface]]\nname = \"{}\"\nkind = \"{}\"\narea_m2 = {:.1f}\nu_W_m2K = {}\n{}\n",
      name, kind, area_m2, u_W_m2K, rest);
}

std::string envelope() {
  std::string text = fmt::format(
      "[building]\nfloor_area_m2 = {:.0f}\nstoreys = {}\nstorey_height_m = {}\nmass = "
      "\"heavy\"\n\n",
      floor_area_m2, storeys, storey_height_m);
  const double height_m = storeys * storey_height_m;
  for (std::size_t side = south; side <= west; ++side) {
    const double facade_m2 = facade_length_m[side] * height_m;
    text += surface(fmt::format("{} wall", side_names[side]), "wall",
                    (1.0 - window_share) * facade_m2, wall_u_W_m2K,
                    fmt::format("azimuth_deg = {:.0f}\nsolar_absorptance = {}\n",
                                facade_azimuth_deg[side], wall_absorptance));
    text += surface(fmt::format("{} windows", side_names[side]), "window", window_share * facade_m2,
                    window_u_W_m2K,
                    fmt::format("azimuth_deg = {:.0f}\nshgc = {}\nframe_fraction = {}\n"
                                "shading_factor = {}\n",
                                facade_azimuth_deg[side], window_shgc, window_frame_share,
                                window_shading_factor));
  }
  text += surface("roof", "roof", storey_area_m2, roof_u_W_m2K,
                  fmt::format("solar_absorptance = {}\n", roof_absorptance));
  text += surface("ground slab", "ground", storey_area_m2, ground_u_W_m2K, "");
  return text;
}

std::string use() {
  const double lighting_W_m2 =
      (office_lighting_W_m2 * office_area_m2 + laboratory_lighting_W_m2 * laboratory_area_m2) /
      floor_area_m2;
  const double plugs_W_m2 = (office_plugs_W_m2 * office_area_m2 +
                             laboratory_plugs_W_m2 * storeys * zone_area_m2[laboratory] +
                             equipment_plugs_W_m2 * storeys * zone_area_m2[equipment]) /
                            floor_area_m2;
  return fmt::format(R"([building.use]
occupancy_person_m2 = {}   # people assigned to the building / floor area
sensible_W_person = {}
latent_W_person = {}
lighting_W_m2 = {:.1f}
plugs_W_m2 = {:.1f}
exterior_kW = {}
zone_heat_share = {}

[building.schedule]   # people present / assigned, by local hour
workday = [0, 0, 0, 0, 0, 0, 0.03, 0.15, 0.41, 0.67, 0.78, 0.79, 0.62, 0.68, 0.79, 0.80, 0.72, 0.46, 0.19, 0.07, 0.04, 0.03, 0.01, 0]
saturday = [0, 0, 0, 0, 0, 0, 0, 0.01, 0.01, 0.02, 0.03, 0.04, 0.04, 0.04, 0.03, 0.03, 0.02, 0.01, 0.01, 0, 0, 0, 0, 0]
sunday = [0, 0, 0, 0, 0, 0, 0, 0.01, 0.01, 0.02, 0.03, 0.04, 0.04, 0.04, 0.03, 0.03, 0.02, 0.01, 0.01, 0, 0, 0, 0, 0]

)",
                     occupancy_person_m2, sensible_W_person, latent_W_person, lighting_W_m2,
                     plugs_W_m2, exterior_kW, zone_heat_share);
}

std::string operation() {
  // Laboratories hold their set-points at night, offices float: the floor-area means.
  const double laboratory_share = laboratory_area_m2 / floor_area_m2;
  const double night_cooling_C =
      laboratory_share * cooling_setpoint_C + (1.0 - laboratory_share) * office_night_cooling_C;
  const double night_heating_C =
      laboratory_share * heating_setpoint_C + (1.0 - laboratory_share) * office_night_heating_C;
  const double night_outdoor_share =
      storeys * laboratory_night_share * laboratory_outdoor_m3_s / outdoor_air_m3_s;
  return fmt::format(R"([building.setpoint]
cooling_occupied_C = {}
cooling_unoccupied_C = {:.0f}
heating_occupied_C = {}
heating_unoccupied_C = {:.0f}
occupied_from = {:.0f}
occupied_to = {:.0f}

[building.infiltration]
ela_cm2_m2 = {}

[building.air]
outdoor_air_m3_s = {:.1f}
outdoor_air_unoccupied_fraction = {:.2f}   # laboratories run always
supply_flow_design_m3_s = {:.1f}
supply_flow_min_m3_s = {:.1f}
supply_temperature_C = {}
fan_design_kW = {}
pump_design_kW = {}

)",
                     cooling_setpoint_C, night_cooling_C, heating_setpoint_C, night_heating_C,
                     occupied_from_h, occupied_to_h, leakage_cm2_m2, outdoor_air_m3_s,
                     night_outdoor_share, supply_design_m3_s, supply_min_m3_s, supply_C, fan_kW,
                     pump_kW);
}

std::string services() {
  return fmt::format(R"([building.heating]
loss_fraction = {}
efficiency = {}

[building.cooling]
loss_fraction = {}

[building.hot_water]
volume_m3_day = {}
temperature_C = {}
mains_C = {}
efficiency = {}

[building.ground]
temperature_C = {}
)",
                     steam_loss, converter_efficiency, chilled_water_loss, hot_water_m3_day,
                     hot_water_C, mains_C, hot_water_efficiency, ground_C);
}

}  // namespace

std::string site_toml(const Period& period) {
  return heading(period) + meters() + periods_and_model(period) + envelope() + use() + operation() +
         services();
}

}  // namespace recald::simulators
