#include "simulators/scenario/sizing.hpp"

#include <algorithm>
#include <cmath>

#include "simulators/climate/normals.hpp"

namespace recald::simulators {
namespace {

constexpr double kAirHeat_kJ_m3K = 1.15 * 1.006;
constexpr double kIndoorSummer_C = 24.0;
constexpr double kIndoorWinter_C = 21.0;

/// Per floor area after ASHRAE 62.1-2016 table 6.2.2.1 at its default densities, or what hoods and
/// bath rooms take out (6.5); clinics after ASHRAE 170 (2 to 3 outdoor air changes an hour).
double outdoor_air_l_s_m2(const Drawings& drawings, bool perimeter) {
  switch (drawings.use) {
    case Use::laboratory:
      return perimeter ? 0.8 : 3.1;
    case Use::office:
      return perimeter ? 0.75 : 0.65;
    case Use::school:
      return perimeter ? 1.5 : 0.9;
    case Use::shop:
      return 1.2;
    case Use::hotel:
      return perimeter ? 0.6 : 0.8;
    case Use::clinic:
      return perimeter ? 1.6 : 2.4;
    case Use::warehouse:
      return 0.3;
    case Use::restaurant:
      return perimeter ? 3.2 : 6.0;
    case Use::gym:
      return perimeter ? 1.4 : 1.8;
  }
  return 0.0;
}

/// Per day and person, or per place where people come and go. ASHRAE Applications ch. 50: 3.8
/// litres in offices, 9 per meal; CIBSE Guide G: about 100 per hotel bed, 25 and more per shower.
double hot_water_m3_person(Use use) {
  switch (use) {
    case Use::laboratory:
      return 0.015;
    case Use::office:
    case Use::school:
      return 0.004;
    case Use::shop:
      return 0.003;
    case Use::hotel:
      return 0.095;
    case Use::clinic:
      return 0.040;
    case Use::warehouse:
      return 0.012;
    case Use::restaurant:
      return 0.018;
    case Use::gym:
      return 0.070;
  }
  return 0.0;
}

/// Peak sensible load of a zone by rule of thumb: people and machines, full sun, walls.
double peak_load_W(const Drawings& drawings, std::size_t side, double design_C) {
  constexpr std::array<double, 4> sun_W_m2{450.0, 180.0, 650.0, 700.0};
  const RoomUse& rooms = drawings.rooms(side);
  const double busy = rooms.plugs_standing_share + rooms.plugs_people_share +
                      rooms.plugs_working_share + (rooms.appliance_runs ? 0.15 : 0.0);
  const double gains_W_m2 =
      drawings.zone_heat_share * (rooms.lighting_W_m2 + busy * rooms.plugs_W_m2) +
      drawings.sensible_W_person * drawings.occupancy_person_m2;
  double load_W = gains_W_m2 * drawings.zone_m2(side);
  if (side <= west) {
    const double facade_m2 = drawings.facade_length_m(side) * drawings.storey_height_m;
    const double window_m2 = drawings.window_share * facade_m2;
    load_W += window_m2 * drawings.window_shgc * (1.0 - drawings.window_frame_share) * 0.65 *
              sun_W_m2[side];
    load_W +=
        (window_m2 * drawings.window_u_W_m2K + (facade_m2 - window_m2) * drawings.wall_u_W_m2K) *
        (design_C - kIndoorSummer_C);
  }
  if (side == core && drawings.skylight_share > 0.0) {
    load_W += drawings.skylight_m2() * drawings.window_shgc * 700.0;
  }
  if (drawings.hall) {
    constexpr double roof_in_sun_K = 25.0;  // above the air, dark roofs
    load_W += drawings.roof_u_W_m2K * drawings.zone_m2(side) *
              (design_C + roof_in_sun_K - kIndoorSummer_C) / static_cast<double>(drawings.storeys);
  }
  return load_W;
}

/// The air that heats a hall in winter: boxes open half way and supply 33 degC.
double heating_flow_m3_s(const Drawings& drawings, std::size_t side, double design_C) {
  constexpr double warmest_C = 33.0;
  constexpr double open_share = 0.5;
  constexpr double through_cracks_m_s = 1.6;  // at 2 Pa
  const double roof_m2 = drawings.zone_m2(side) / static_cast<double>(drawings.storeys);
  double loss_W_K = drawings.roof_u_W_m2K * roof_m2;
  if (side <= west) {
    const double facade_m2 = drawings.facade_length_m(side) * drawings.storey_height_m;
    const double window_m2 = drawings.window_share * facade_m2;
    loss_W_K +=
        window_m2 * drawings.window_u_W_m2K + (facade_m2 - window_m2) * drawings.wall_u_W_m2K;
    loss_W_K += 1000.0 * kAirHeat_kJ_m3K * through_cracks_m_s * 1e-4 * drawings.leakage_cm2_m2 *
                (facade_m2 + roof_m2 / drawings.perimeter_floor_share());
  }
  const double lift_K = warmest_C - drawings.heating_setpoint_C;
  return loss_W_K * (drawings.heating_setpoint_C - design_C) /
         (1000.0 * kAirHeat_kJ_m3K * open_share * lift_K);
}

void size_flows(Drawings& drawings, const Normals& normals) {
  constexpr double supply_difference_K = 11.0;
  constexpr double margin = 1.15;
  for (std::size_t side = south; side <= special; ++side) {
    double flow_m3_s = margin * peak_load_W(drawings, side, normals.cooling_design_C) /
                       (1000.0 * kAirHeat_kJ_m3K * supply_difference_K);
    if (drawings.hall) {
      flow_m3_s = std::max(flow_m3_s, heating_flow_m3_s(drawings, side, normals.heating_design_C));
    }
    drawings.zone_supply_m3_s[side] = std::max(0.05, in_steps(flow_m3_s, 0.01));
  }
}

AirHandlerPlate air_handler_for(const Drawings& drawings, bool perimeter, double design_winter_C) {
  const double area_m2 = perimeter ? drawings.storey_m2() - drawings.core_and_special_m2()
                                   : drawings.core_and_special_m2();
  const double flow_m3_s =
      perimeter ? drawings.perimeter_supply_m3_s() : drawings.core_supply_m3_s();
  const double outdoor_m3_s =
      std::min(0.9 * flow_m3_s, outdoor_air_l_s_m2(drawings, perimeter) * area_m2 / 1000.0);
  const bool exhausts = drawings.use == Use::laboratory && !perimeter;
  // Humid outdoor air loads the coil more than return air.
  const double moisture =
      drawings.climate == ClimateKind::hot_humid || drawings.climate == ClimateKind::mixed ? 46.0
                                                                                           : 28.0;
  return {.outdoor_m3_s = in_steps(outdoor_m3_s, 0.01),
          .fan_kW = std::max(0.2, in_steps((exhausts ? 2.1 : 1.7) * flow_m3_s, 0.1)),
          .fan_share_in_airstream = exhausts ? 0.60 : 0.75,
          .coil_kW = std::max(5.0, in_steps(21.0 * flow_m3_s + moisture * outdoor_m3_s, 1.0)),
          .coil_bypass_factor = exhausts ? 0.07 : 0.10,
          .preheat_kW = std::max(
              5.0, in_steps(1.5 * kAirHeat_kJ_m3K * outdoor_m3_s * (14.0 - design_winter_C), 1.0))};
}

/// In a hall, half of the outdoor air leaves through cracks and the rest through ducts; in a
/// kitchen the hoods take all of it.
double pressurised_Pa(const Drawings& drawings) {
  constexpr double tight_Pa = 3.0;
  if (!drawings.hall) return tight_Pa;
  if (drawings.use == Use::restaurant) return 0.0;
  const double facade_m2 = 2.0 * (drawings.length_m + drawings.width_m) *
                           static_cast<double>(drawings.storeys) * drawings.storey_height_m;
  const double cracks_m2 = 1e-4 * drawings.leakage_cm2_m2 * (facade_m2 + drawings.storey_m2());
  const double at_4_Pa_m3_s = cracks_m2 * std::sqrt(2.0 * 4.0 / 1.2);
  const double share = 0.5 * drawings.outdoor_air_m3_s() / at_4_Pa_m3_s;
  return std::min(tight_Pa, std::round(40.0 * std::pow(share, 1.0 / 0.65)) / 10.0);
}

double envelope_W_K(const Drawings& drawings) {
  const double facade_m2 = 2.0 * (drawings.length_m + drawings.width_m) *
                           static_cast<double>(drawings.storeys) * drawings.storey_height_m;
  const double window_m2 = drawings.window_share * facade_m2 + drawings.skylight_m2();
  return window_m2 * drawings.window_u_W_m2K + (facade_m2 - window_m2) * drawings.wall_u_W_m2K +
         drawings.storey_m2() * drawings.roof_u_W_m2K;
}

double connected_kW(const Drawings& drawings) {
  double rooms_kW = 0.0;
  for (std::size_t side = south; side <= special; ++side) {
    const RoomUse& rooms = drawings.rooms(side);
    rooms_kW += (rooms.lighting_W_m2 + rooms.plugs_W_m2) * drawings.zone_m2(side) / 1000.0;
  }
  const double storey_kW = rooms_kW + drawings.perimeter_air.fan_kW + drawings.core_air.fan_kW;
  double sum_kW =
      static_cast<double>(drawings.storeys) * storey_kW + drawings.pump_kW + drawings.exterior_kW;
  if (drawings.cooling != CoolingPlant::district) {
    sum_kW += drawings.chilled_water_design_kW / drawings.chiller_cop;
  }
  if (drawings.heating == HeatingPlant::heat_pump) sum_kW += 0.6 * drawings.heating_design_kW;
  return sum_kW;
}

}  // namespace

void size_services(Drawings& drawings) {
  const Normals& normals = normals_of(drawings.climate);
  const auto storeys = static_cast<double>(drawings.storeys);
  size_flows(drawings, normals);
  drawings.perimeter_air = air_handler_for(drawings, true, normals.heating_design_C);
  drawings.core_air = air_handler_for(drawings, false, normals.heating_design_C);
  drawings.pressurised_Pa = pressurised_Pa(drawings);
  const double coils_kW = storeys * (drawings.perimeter_air.coil_kW + drawings.core_air.coil_kW);
  drawings.chilled_water_design_kW = in_steps(0.65 * coils_kW, 1.0);
  const double heat_W_K =
      envelope_W_K(drawings) + 1000.0 * kAirHeat_kJ_m3K * drawings.outdoor_air_m3_s();
  drawings.heating_design_kW =
      in_steps(1.3 * heat_W_K * (kIndoorWinter_C - normals.heating_design_C) / 1000.0, 1.0);
  const bool packaged = drawings.cooling == CoolingPlant::packaged;
  const double chilled_water_kW = packaged ? 0.0 : drawings.chilled_water_design_kW;
  drawings.pump_kW =
      std::max(0.3, in_steps(0.0085 * (chilled_water_kW + 0.5 * drawings.heating_design_kW), 0.1));
  drawings.exterior_kW = in_steps(0.0007 * drawings.floor_area_m2(), 0.1);
  drawings.heating_standing_kW = in_steps(0.008 * drawings.heating_design_kW, 0.1);
  drawings.chilled_water_standing_kW = in_steps(0.0005 * chilled_water_kW, 0.1);
  const double people = drawings.occupancy_person_m2 * drawings.floor_area_m2();
  drawings.hot_water_m3_day =
      std::max(0.1, in_steps(hot_water_m3_person(drawings.use) * people, 0.1));
  drawings.electricity_rated_kW = in_steps(2.0 * connected_kW(drawings), 10.0);
  drawings.cooling_rated_kW = in_steps(1.7 * coils_kW, 10.0);
  drawings.heat_rated_kW = in_steps(2.8 * drawings.heating_design_kW, 10.0);
}

double in_steps(double value, double step) { return std::round(value / step) * step; }

}  // namespace recald::simulators
