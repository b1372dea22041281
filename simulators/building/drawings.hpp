/// The campus laboratory building as its drawings and nameplates show it.
///
/// Three storeys of 65 m × 40 m; offices 6 m deep along all four facades around a laboratory core.
/// The site file quotes these numbers; the simulated truth scatters around them.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "simulators/climate/sun.hpp"

namespace recald::simulators::drawings {

inline constexpr std::string_view time_zone = "America/New_York";
inline constexpr Place place{33.65, -84.43, 308.0};

inline constexpr std::size_t storeys = 3;
inline constexpr std::size_t zones_per_storey = 6;
inline constexpr std::size_t zones = storeys * zones_per_storey;
inline constexpr std::size_t air_handlers = 2 * storeys;  ///< Per storey: offices, laboratories.
inline constexpr double storey_height_m = 4.2;
inline constexpr double length_m = 65.0;  ///< South and north facades.
inline constexpr double width_m = 40.0;   ///< East and west facades.
inline constexpr double perimeter_depth_m = 6.0;
inline constexpr double storey_area_m2 = length_m * width_m;
inline constexpr double floor_area_m2 = storeys * storey_area_m2;

/// A storey's zones: four offices, the open laboratory, and the equipment rooms inside it
/// (freezers, instruments), which are small and hot.
enum Side : std::size_t { south, north, east, west, laboratory, equipment };
inline constexpr std::array<std::string_view, 4> side_names{"south", "north", "east", "west"};
inline constexpr std::array<double, 4> facade_azimuth_deg{180.0, 0.0, 90.0, 270.0};
inline constexpr std::array<double, 4> facade_length_m{length_m, length_m, width_m, width_m};
inline constexpr double core_area_m2 =
    (length_m - 2 * perimeter_depth_m) * (width_m - 2 * perimeter_depth_m);
inline constexpr double equipment_share_of_core = 0.3;
/// The long facades own the corners.
inline constexpr std::array<double, zones_per_storey> zone_area_m2{
    length_m * perimeter_depth_m,
    length_m* perimeter_depth_m,
    (width_m - 2 * perimeter_depth_m) * perimeter_depth_m,
    (width_m - 2 * perimeter_depth_m) * perimeter_depth_m,
    (1.0 - equipment_share_of_core) * core_area_m2,
    equipment_share_of_core* core_area_m2};
inline constexpr double laboratory_area_m2 = storeys * core_area_m2;
inline constexpr double office_area_m2 = floor_area_m2 - laboratory_area_m2;

inline constexpr double window_share = 0.35;
inline constexpr double wall_u_W_m2K = 0.45;
inline constexpr double roof_u_W_m2K = 0.30;
inline constexpr double window_u_W_m2K = 2.4;
inline constexpr double ground_u_W_m2K = 0.35;
inline constexpr double window_shgc = 0.38;
inline constexpr double window_frame_share = 0.15;
inline constexpr double window_shading_factor = 0.8;
inline constexpr double wall_absorptance = 0.6;
inline constexpr double roof_absorptance = 0.7;
inline constexpr double leakage_cm2_m2 = 1.3;  ///< At 4 Pa, per m² of exterior wall and roof.

inline constexpr double occupancy_person_m2 = 0.05;
inline constexpr double sensible_W_person = 75.0;
inline constexpr double latent_W_person = 55.0;
inline constexpr double office_lighting_W_m2 = 9.5;
inline constexpr double laboratory_lighting_W_m2 = 10.5;
inline constexpr double office_plugs_W_m2 = 11.0;
inline constexpr double laboratory_plugs_W_m2 = 27.0;
inline constexpr double equipment_plugs_W_m2 = 60.0;
inline constexpr double exterior_kW = 6.0;
inline constexpr double zone_heat_share = 0.9;

inline constexpr double cooling_setpoint_C = 24.0;
inline constexpr double heating_setpoint_C = 21.0;
inline constexpr double office_night_cooling_C = 29.0;
inline constexpr double office_night_heating_C = 17.0;
inline constexpr double occupied_from_h = 6.0;
inline constexpr double occupied_to_h = 20.0;

inline constexpr double supply_C = 13.0;
/// Largest supply flow of the zone on one storey, m³/s, in the order of `Side`.
inline constexpr std::array<double, zones_per_storey> zone_supply_m3_s{1.9,  1.4, 1.15,
                                                                       1.25, 6.0, 2.6};
inline constexpr double office_supply_m3_s = zone_supply_m3_s[south] + zone_supply_m3_s[north] +
                                             zone_supply_m3_s[east] + zone_supply_m3_s[west];
inline constexpr double core_supply_m3_s =
    zone_supply_m3_s[laboratory] + zone_supply_m3_s[equipment];
inline constexpr double office_min_share = 0.35;
inline constexpr double laboratory_min_share = 0.66;
inline constexpr double equipment_min_share = 0.30;
inline constexpr double office_outdoor_m3_s = 0.9;
inline constexpr double laboratory_outdoor_m3_s = 3.5;
inline constexpr double laboratory_night_share = 0.9;  ///< Of outdoor air and minimum flow.
inline constexpr double outdoor_air_m3_s =
    storeys * (office_outdoor_m3_s + laboratory_outdoor_m3_s);
inline constexpr double supply_design_m3_s = storeys * (office_supply_m3_s + core_supply_m3_s);
inline constexpr double supply_min_m3_s =
    storeys *
    (office_min_share * office_supply_m3_s + laboratory_min_share * zone_supply_m3_s[laboratory] +
     equipment_min_share * zone_supply_m3_s[equipment]);
inline constexpr double office_fan_kW = 10.0;      ///< One air handler, all its fans.
inline constexpr double laboratory_fan_kW = 18.0;  ///< Exhaust included.
inline constexpr double fan_kW = storeys * (office_fan_kW + laboratory_fan_kW);
inline constexpr double pump_kW = 12.0;
inline constexpr double office_coil_kW = 150.0;
inline constexpr double laboratory_coil_kW = 340.0;

inline constexpr double chilled_water_loss = 0.03;
inline constexpr double steam_loss = 0.08;
inline constexpr double converter_efficiency = 0.97;
inline constexpr double hot_water_m3_day = 6.0;
inline constexpr double hot_water_C = 55.0;
inline constexpr double mains_C = 17.0;
inline constexpr double hot_water_efficiency = 0.85;
inline constexpr double ground_C = 18.0;

}  // namespace recald::simulators::drawings
