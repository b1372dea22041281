#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulators/building/calendar.hpp"
#include "simulators/scenario/scenario_files.hpp"

namespace recald::simulators {
namespace {

constexpr std::size_t kColumns = 100;

/// A comment wrapped over several lines.
std::string as_comment(std::string_view text) {
  std::string out = "#";
  std::size_t column = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (column + 1 + (end - at) > kColumns) {
      out += "\n#";
      column = 1;
    }
    out += ' ';
    out += text.substr(at, end - at);
    column += 1 + (end - at);
    at = end + 1;
  }
  return out + "\n";
}

std::string holiday_list(const Drawings& drawings, const Period& period) {
  const Calendar calendar(drawings.calendar);
  std::string list;
  for (int year = period.start_year; year < period.start_year + period.years; ++year) {
    for (const metering::Day day : calendar.holidays_of(std::chrono::year{year})) {
      list += fmt::format("  \"{}\",\n", metering::to_string(day));
    }
  }
  return list;
}

std::string heading(const Drawings& drawings, const Period& period) {
  return as_comment(drawings.description + " Numbers are those of drawings and nameplates.") +
         fmt::format(
             R"(
[site]
id = "{}"
name = "{}"
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
values = "mean"

)",
             drawings.id, drawings.name, drawings.time_zone, drawings.place.latitude_deg,
             drawings.place.longitude_deg, drawings.place.altitude_m,
             holiday_list(drawings, period));
}

std::string meter(const MeterPlate& plate) {
  std::string text = fmt::format(R"([[meter]]
id = "{}"
utility = "{}"
file = "readings.csv"
stamps = "start"
rated_kW = {:.0f}
)",
                                 plate.id, plate.kind, plate.rated_kW);
  if (plate.in_steam_pit) {
    text += "zero_run_max = \"6h\"   # longest believable run of exact zeros\nstuck_max = \"3h\"\n";
  }
  return text + "\n";
}

std::string meters(const Scenario& scenario) {
  // Electricity first, the usual order.
  std::vector<MeterPlate> plates = plates_of(scenario.drawings);
  if (has_decoy(scenario, Decoy::neighbour_meter)) plates.push_back(neighbour_plate());
  std::ranges::stable_partition(
      plates, [](const MeterPlate& plate) { return plate.utility == Utility::electricity; });
  std::string text;
  for (const MeterPlate& plate : plates) text += meter(plate);
  return text;
}

std::string outputs(const Drawings& drawings) {
  std::string list = "\"electricity\"";
  bool poor = false;
  for (const MeterPlate& plate : plates_of(drawings)) {
    if (plate.utility != Utility::electricity) list += fmt::format(", \"{}\"", plate.id);
    poor = poor || plate.in_steam_pit;
  }
  return fmt::format(
      "outputs = [{}]\n{}", list,
      poor ? "weights = { steam = 0.5 }   # the steam meter is known to be poor\n" : "");
}

/// The last year is for validation; of a single year, the last four months.
std::string periods_and_model(const Drawings& drawings, const Period& period) {
  const int last_year = period.start_year + period.years - 1;
  const bool single = period.years == 1;
  const std::string calibration_end =
      single ? fmt::format("{}-08", last_year) : fmt::format("{}-12", last_year - 1);
  return fmt::format(R"([period]
calibration = {{ from = "{}-01", to = "{}" }}
validation = {{ from = "{}-{}", to = "{}-12" }}

[[model]]
kind = "epc"
{}
)",
                     period.start_year, calibration_end, last_year, single ? "09" : "01", last_year,
                     outputs(drawings));
}

std::string surface(std::string_view name, std::string_view kind, double area_m2, double u_W_m2K,
                    std::string_view rest) {
  return fmt::format(
      "[[building.surface]]\nname = \"{}\"\nkind = \"{}\"\narea_m2 = {:.1f}\nu_W_m2K = {}\n{}\n",
      name, kind, area_m2, u_W_m2K, rest);
}

std::string window(const Drawings& drawings, std::string_view name, double area_m2,
                   std::string_view direction) {
  return surface(name, "window", area_m2, drawings.window_u_W_m2K,
                 fmt::format("{}shgc = {}\nframe_fraction = {}\nshading_factor = {}\n", direction,
                             drawings.window_shgc, drawings.window_frame_share,
                             drawings.window_shading_factor));
}

std::string envelope(const Drawings& drawings) {
  std::string text = fmt::format(
      "[building]\nfloor_area_m2 = {:.0f}\nstoreys = {}\nstorey_height_m = {}\nmass = "
      "\"{}\"\n\n",
      drawings.floor_area_m2(), drawings.storeys, drawings.storey_height_m,
      drawings.heavy ? "heavy" : "light");
  const double height_m = static_cast<double>(drawings.storeys) * drawings.storey_height_m;
  for (std::size_t side = south; side <= west; ++side) {
    const double facade_m2 = drawings.facade_length_m(side) * height_m;
    const std::string direction = fmt::format("azimuth_deg = {:.0f}\n", kFacadeAzimuth_deg[side]);
    text +=
        surface(fmt::format("{} wall", kSideNames[side]), "wall",
                (1.0 - drawings.window_share) * facade_m2, drawings.wall_u_W_m2K,
                fmt::format("{}solar_absorptance = {}\n", direction, drawings.wall_absorptance));
    text += window(drawings, fmt::format("{} windows", kSideNames[side]),
                   drawings.window_share * facade_m2, direction);
  }
  text +=
      surface("roof", "roof", drawings.storey_m2() - drawings.skylight_m2(), drawings.roof_u_W_m2K,
              fmt::format("solar_absorptance = {}\n", drawings.roof_absorptance));
  if (drawings.skylight_m2() > 0.0) {
    text +=
        window(drawings, "skylight", drawings.skylight_m2(), "tilt_deg = 0\nazimuth_deg = 180\n");
  }
  text += surface("ground slab", "ground", drawings.storey_m2(), drawings.ground_u_W_m2K, "");
  return text;
}

std::string by_hour(const std::array<double, 24>& presence) {
  std::string list;
  for (const double share : presence) {
    if (!list.empty()) list += ", ";
    list += share == 0.0 ? "0" : fmt::format("{:.2f}", share);
  }
  return list;
}

/// Floor-area mean of a density over the storey's rooms.
double mean_W_m2(const Drawings& drawings, double RoomUse::*density_W_m2) {
  double sum_W = 0.0;
  for (std::size_t side = south; side <= special; ++side) {
    sum_W += drawings.rooms(side).*density_W_m2 * drawings.zone_m2(side);
  }
  return sum_W / drawings.storey_m2();
}

std::string use(const Drawings& drawings) {
  return fmt::format(R"([building.use]
occupancy_person_m2 = {}   # people assigned to the building / floor area
sensible_W_person = {}
latent_W_person = {}
lighting_W_m2 = {:.1f}
plugs_W_m2 = {:.1f}
exterior_kW = {}
zone_heat_share = {}

[building.schedule]   # people present / assigned, by local hour
workday = [{}]
saturday = [{}]
sunday = [{}]

)",
                     drawings.occupancy_person_m2, drawings.sensible_W_person,
                     drawings.latent_W_person, mean_W_m2(drawings, &RoomUse::lighting_W_m2),
                     mean_W_m2(drawings, &RoomUse::plugs_W_m2), drawings.exterior_kW,
                     drawings.zone_heat_share, by_hour(drawings.presence_workday),
                     by_hour(drawings.presence_saturday), by_hour(drawings.presence_sunday));
}

/// Share of the outdoor air that runs while nobody is expected.
double night_outdoor_share(const Drawings& drawings) {
  const auto storeys = static_cast<double>(drawings.storeys);
  double share = 0.0;
  for (const bool perimeter : {true, false}) {
    if (!drawings.runs_always(perimeter)) continue;
    const AirHandlerPlate& plate = perimeter ? drawings.perimeter_air : drawings.core_air;
    share += storeys * drawings.core_night_share * plate.outdoor_m3_s / drawings.outdoor_air_m3_s();
  }
  return share;
}

std::string_view at_night_in_words(const Drawings& drawings) {
  if (drawings.use == Use::clinic) return "wards run always";
  if (drawings.never_stops()) return "air handlers never stop, on no day";
  return drawings.core_runs_always ? "laboratories run always" : "air handlers stop at night";
}

std::string operation(const Drawings& drawings) {
  // Rooms that never float keep their set-points at night: the floor-area means.
  const auto storeys = static_cast<double>(drawings.storeys);
  const double core_share = storeys * drawings.core_and_special_m2() / drawings.floor_area_m2();
  const double held_share = drawings.never_stops()      ? 1.0
                            : drawings.core_runs_always ? core_share
                                                        : 0.0;
  const double night_cooling_C =
      held_share * drawings.cooling_setpoint_C + (1.0 - held_share) * drawings.night_cooling_C;
  const double night_heating_C =
      held_share * drawings.heating_setpoint_C + (1.0 - held_share) * drawings.night_heating_C;
  double least_m3_s = 0.0;
  for (std::size_t side = south; side <= special; ++side) {
    least_m3_s += drawings.min_share(side) * drawings.zone_supply_m3_s[side];
  }
  std::string text = fmt::format(
      R"([building.setpoint]
cooling_occupied_C = {}
cooling_unoccupied_C = {:.0f}
heating_occupied_C = {}
heating_unoccupied_C = {:.0f}
occupied_from = {:.0f}
occupied_to = {:.0f}
{}
[building.infiltration]
ela_cm2_m2 = {}

[building.air]
outdoor_air_m3_s = {:.1f}
outdoor_air_unoccupied_fraction = {:.2f}   # {}
supply_flow_design_m3_s = {:.1f}
supply_flow_min_m3_s = {:.1f}
supply_temperature_C = {}
fan_design_kW = {}
pump_design_kW = {}
)",
      drawings.cooling_setpoint_C, night_cooling_C, drawings.heating_setpoint_C, night_heating_C,
      drawings.occupied_from_h, drawings.occupied_to_h,
      is_open(drawings.open_days, DayKind::saturday) ? "saturday_occupied = true\n" : "",
      drawings.leakage_cm2_m2, drawings.outdoor_air_m3_s(), night_outdoor_share(drawings),
      at_night_in_words(drawings),
      storeys * (drawings.perimeter_supply_m3_s() + drawings.core_supply_m3_s()),
      storeys * least_m3_s, drawings.supply_C,
      std::round(10.0 * storeys * (drawings.perimeter_air.fan_kW + drawings.core_air.fan_kW)) /
          10.0,
      drawings.pump_kW);
  if (drawings.economiser_limit_C) {
    text += fmt::format("economiser_lockout_C = {}\n", *drawings.economiser_limit_C);
  }
  return text + "\n";
}

std::string heating(const Drawings& drawings) {
  if (drawings.heating == HeatingPlant::heat_pump) {
    return fmt::format(
        "# Heated by an air-source heat pump (nameplate COP {} at 8.3 degC): its electricity is in "
        "the meter.\n",
        drawings.heat_pump_cop);
  }
  std::string text = fmt::format("[building.heating]\nloss_fraction = {}\nefficiency = {}\n",
                                 drawings.heating_standing_kW ? 0.0 : drawings.heating_loss,
                                 drawings.heating_efficiency);
  if (drawings.heating_standing_kW) {
    text += fmt::format("base_heat_kW = {}   # pipes and traps, all hours\n",
                        *drawings.heating_standing_kW);
  }
  return text;
}

std::string services(const Drawings& drawings) {
  const bool packaged = drawings.cooling == CoolingPlant::packaged;
  std::string text = heating(drawings) + fmt::format("\n[building.cooling]\nloss_fraction = {}\n",
                                                     packaged ? 0.0 : drawings.chilled_water_loss);
  if (drawings.cooling != CoolingPlant::district) {
    text += fmt::format("chiller_cop = {}{}\n", drawings.chiller_cop,
                        packaged ? "   # packaged units, in the electricity meter" : "");
  }
  return text + fmt::format(R"(
[building.hot_water]
volume_m3_day = {}
temperature_C = {}
mains_C = {}
efficiency = {}

[building.ground]
temperature_C = {}
)",
                            drawings.hot_water_m3_day, drawings.hot_water_C, drawings.mains_C,
                            drawings.hot_water_efficiency, drawings.ground_C);
}

}  // namespace

std::string site_toml(const Scenario& scenario) {
  const Drawings& drawings = scenario.drawings;
  return heading(drawings, scenario.period) + meters(scenario) +
         periods_and_model(drawings, scenario.period) + envelope(drawings) + use(drawings) +
         operation(drawings) + services(drawings);
}

}  // namespace recald::simulators
