/// A building as its drawings and nameplates show it.
///
/// The site file quotes these numbers; the simulated building deviates from them at random. The
/// defaults describe the campus laboratory: three storeys of 65 m × 40 m; offices 6 m deep along
/// all four facades around a laboratory core.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "simulators/building/visits.hpp"
#include "simulators/climate/climates.hpp"
#include "simulators/climate/sun.hpp"

namespace recald::simulators {

enum class Use { laboratory, office, school, shop, hotel, clinic, warehouse, restaurant, gym };
inline constexpr std::array kUses{Use::laboratory, Use::office,     Use::school,
                                  Use::shop,       Use::hotel,      Use::clinic,
                                  Use::warehouse,  Use::restaurant, Use::gym};
/// Packaged units cool the air directly: there is no chilled water, and no meter for it.
enum class CoolingPlant { district, chiller, packaged };
enum class HeatingPlant { district_steam, district_water, boiler, heat_pump };

/// The days on which people work there. Holidays count as Sundays.
enum class OpenDays { workdays, workdays_and_saturdays, every_day };

/// The zones of a storey: rooms along the four facades, the core, and special rooms inside it. In
/// the laboratory these are offices, the open laboratory, and small, hot equipment rooms.
enum Side : std::size_t { south, north, east, west, core, special };
inline constexpr std::size_t kZonesPerStorey = 6;
inline constexpr std::array<std::string_view, 4> kSideNames{"south", "north", "east", "west"};
inline constexpr std::array<double, 4> kFacadeAzimuth_deg{180.0, 0.0, 90.0, 270.0};
/// The storeys between the lowest and the highest are alike, so one of them stands for all.
inline constexpr std::size_t kStoreysSimulated = 3;

/// The use of one kind of room.
struct RoomUse {
  double crowding;  ///< People per area relative to the perimeter rooms; 0: nobody sits there.
  double arrival_h, stay_h;  ///< Of the people who sit there, on average.
  double weekend_share_max;  ///< Share of weekend days on which the keenest of them comes.
  double evening_share_max;  ///< Share of days on which the keenest of them returns after dinner.
  double lighting_W_m2;
  double plugs_W_m2;            ///< Installed.
  double plugs_standing_share;  ///< Of the installed plugs, always on.
  double plugs_people_share;    ///< Of them, on in proportion to the people present.
  double plugs_working_share;   ///< Of them, on from 8 to 18 h on working days.
  double plugs_habit;           ///< One standard deviation, from day to day.
  bool appliance_runs;          ///< Autoclaves, ovens, kilns: started and run to the end.
  bool lit_while_open = false;  ///< Sales floors, halls: all lights on, however many people.
  /// People who come and go all day; absent: people who arrive, have lunch and leave as above.
  std::optional<Visits> visits = {};

  /// Of the people present, those who use lights, devices and hot water.
  [[nodiscard]] double awake_share(int minute_of_day) const {
    return visits ? visits->awake[static_cast<std::size_t>(minute_of_day / 60)] : 1.0;
  }
};

/// One air handler's nameplate.
struct AirHandlerPlate {
  double outdoor_m3_s;
  double fan_kW;  ///< All its fans, exhaust included.
  double fan_share_in_airstream;
  double coil_kW;
  double coil_bypass_factor;
  double preheat_kW;
};

struct Drawings {
  Use use = Use::laboratory;
  Use calendar = Use::laboratory;  ///< Sets the holidays and breaks.
  std::string id = "campus-lab";
  std::string name = "Campus laboratory building";
  std::string description =
      "Campus laboratory building: three storeys, offices around a laboratory core, six air "
      "handlers (variable air volume, reheat), chilled water and steam from the district, "
      "electricity from the utility.";
  std::string time_zone = "America/New_York";
  Place place{33.65, -84.43, 308.0};
  ClimateKind climate = ClimateKind::hot_humid;

  std::size_t storeys = 3;
  double storey_height_m = 4.2;
  double length_m = 65.0;  ///< South and north facades.
  double width_m = 40.0;   ///< East and west facades.
  double perimeter_depth_m = 6.0;
  double special_share_of_core = 0.3;
  /// One large room under its own roof: air enters over the whole height and
  /// through the whole roof.
  bool hall = false;

  double window_share = 0.35;
  double skylight_share = 0.0;  ///< Of the core's roof.
  double wall_u_W_m2K = 0.45;
  double roof_u_W_m2K = 0.30;
  double window_u_W_m2K = 2.4;
  double ground_u_W_m2K = 0.35;
  double window_shgc = 0.38;
  double window_frame_share = 0.15;
  double window_shading_factor = 0.8;
  double wall_absorptance = 0.6;
  double roof_absorptance = 0.7;
  double leakage_cm2_m2 = 1.3;  ///< At 4 Pa, per m² of exterior wall and roof.
  /// Pressure of the rooms against outdoors while the perimeter's air handler supplies outdoor air.
  double pressurised_Pa = 3.0;
  bool heavy = true;  ///< Concrete slabs and block walls, or steel deck and stud walls.

  double occupancy_person_m2 = 0.05;
  double sensible_W_person = 75.0;
  double latent_W_person = 55.0;
  RoomUse perimeter_rooms{1.35, 8.5, 8.7, 0.08, 0.04, 9.5, 11.0, 0.30, 0.62, 0.0, 0.03, false};
  RoomUse core_rooms{1.0, 9.0, 9.2, 0.25, 0.16, 10.5, 27.0, 0.42, 0.32, 0.0, 0.06, true};
  RoomUse special_rooms{0.0, 0.0, 0.0, 0.0, 0.0, 10.5, 60.0, 0.60, 0.0, 0.06, 0.06, true};
  /// People present / assigned by local hour, as in the site file.
  HourlyShares presence_workday{0,    0,    0,    0,    0,    0,    0.03, 0.15,
                                0.41, 0.67, 0.78, 0.79, 0.62, 0.68, 0.79, 0.80,
                                0.72, 0.46, 0.19, 0.07, 0.04, 0.03, 0.01, 0};
  HourlyShares presence_saturday{0,    0,    0,    0,    0,    0,    0,    0.01,
                                 0.01, 0.02, 0.03, 0.04, 0.04, 0.04, 0.03, 0.03,
                                 0.02, 0.01, 0.01, 0,    0,    0,    0,    0};
  HourlyShares presence_sunday = presence_saturday;
  /// Fewer people come in summer, over Christmas and in breaks; the user is not told.
  bool attendance_follows_season = true;
  OpenDays open_days = OpenDays::workdays;
  double working_from_h = 8.0;  ///< On open days: loads that run while people work, lit halls.
  double working_to_h = 18.0;
  double cleaning_from_h = 19.0;  ///< On open days; none if `to` is not later.
  double cleaning_to_h = 21.5;
  /// Air through the doors between the core and each room around it, kg/s; none on a sales floor.
  double between_rooms_kg_s = 0.12;
  double exterior_kW = 6.0;
  double zone_heat_share = 0.9;  ///< Of lights and plugs; the rest leaves with the exhaust.

  double cooling_setpoint_C = 24.0;
  double heating_setpoint_C = 21.0;
  double heating_setpoint_min_C = 20.3;  ///< The lowest thermostat setting found in such buildings.
  double heating_setpoint_max_C = 21.9;
  double night_cooling_C = 29.0;
  double night_heating_C = 17.0;
  double occupied_from_h = 6.0;
  double occupied_to_h = 20.0;

  /// Whether air handlers with a timetable run from 8 to 14 h on Saturdays; absent: the
  /// drawings do not say.
  std::optional<bool> saturday_operation;
  bool perimeter_runs_always = false;  ///< The perimeter's air handlers never stop.
  bool core_runs_always = true;        ///< Likewise the core's.
  double core_night_share = 0.9;  ///< Of their outdoor air and minimum flow, if they never stop.
  double supply_C = 13.0;
  /// Largest supply flow of the zone on one storey, m³/s, in the order of `Side`.
  std::array<double, kZonesPerStorey> zone_supply_m3_s{1.9, 1.4, 1.15, 1.25, 6.0, 2.6};
  double perimeter_min_share = 0.35;
  double core_min_share = 0.66;
  double special_min_share = 0.30;
  AirHandlerPlate perimeter_air{0.9, 10.0, 0.70, 150.0, 0.10, 60.0};  ///< One a storey.
  AirHandlerPlate core_air{3.5, 18.0, 0.60, 340.0, 0.07, 160.0};      ///< One a storey.
  /// No extra outdoor air is taken above this dry bulb. Absent: there is no economiser, as ASHRAE
  /// 90.1 allows in climate zone 3A.
  std::optional<double> economiser_limit_C;

  CoolingPlant cooling = CoolingPlant::district;
  HeatingPlant heating = HeatingPlant::district_steam;
  double chilled_water_design_kW = 900.0;
  double heating_design_kW = 700.0;
  double pump_kW = 12.0;
  double chilled_water_loss = 0.03;
  double heating_loss = 0.08;
  /// Constant losses and gains of pipes, whatever the load; absent: the drawings do not say.
  std::optional<double> heating_standing_kW;
  std::optional<double> chilled_water_standing_kW;
  double heating_efficiency = 0.97;  ///< Of converter, heat exchanger or boiler.
  double chiller_cop = 5.2;          ///< Nameplate at full load, towers included.
  double heat_pump_cop = 3.2;        ///< Nameplate at 8.3 degC outdoors.
  double hot_water_m3_day = 6.0;
  /// Of the day's mean flow, with all people there; a quarter of the mean flows in any case.
  double hot_water_with_people = 2.4;
  double hot_water_C = 55.0;
  double mains_C = 17.0;
  double hot_water_efficiency = 0.85;
  double ground_C = 18.0;

  // Sizes of the meters, called rated in the site file, in kW.
  double electricity_rated_kW = 900.0;
  double cooling_rated_kW = 2500.0;
  double heat_rated_kW = 2000.0;

  [[nodiscard]] std::size_t storeys_simulated() const {
    return storeys < kStoreysSimulated ? storeys : kStoreysSimulated;
  }
  /// Number of real storeys that this simulated one stands for.
  [[nodiscard]] double storey_weight(std::size_t storey) const {
    return storey == 1 && storeys > kStoreysSimulated
               ? static_cast<double>(storeys - kStoreysSimulated + 1)
               : 1.0;
  }
  [[nodiscard]] std::size_t zones() const { return storeys_simulated() * kZonesPerStorey; }
  [[nodiscard]] std::size_t air_handlers() const { return 2 * storeys_simulated(); }
  [[nodiscard]] double storey_m2() const { return length_m * width_m; }
  [[nodiscard]] double floor_area_m2() const { return static_cast<double>(storeys) * storey_m2(); }
  [[nodiscard]] double core_and_special_m2() const {
    return (length_m - 2 * perimeter_depth_m) * (width_m - 2 * perimeter_depth_m);
  }
  [[nodiscard]] double perimeter_floor_share() const {
    return 1.0 - core_and_special_m2() / storey_m2();
  }
  /// The share of all people in the rooms along the facades; the others are in the core.
  [[nodiscard]] double perimeter_people_share() const {
    return perimeter_rooms.crowding * (storey_m2() - core_and_special_m2()) / storey_m2();
  }
  [[nodiscard]] double facade_length_m(std::size_t side) const {
    return side == south || side == north ? length_m : width_m;
  }
  /// On one storey. The long facades own the corners.
  [[nodiscard]] double zone_m2(std::size_t side) const;
  [[nodiscard]] double skylight_m2() const { return skylight_share * zone_m2(core); }
  [[nodiscard]] const RoomUse& rooms(std::size_t side) const {
    return side == special ? special_rooms : side == core ? core_rooms : perimeter_rooms;
  }
  [[nodiscard]] bool runs_always(bool perimeter) const {
    return perimeter ? perimeter_runs_always : core_runs_always;
  }
  /// No air handler ever stops, so the timetable has no effect.
  [[nodiscard]] bool never_stops() const { return perimeter_runs_always && core_runs_always; }
  [[nodiscard]] double min_share(std::size_t side) const {
    return side == special ? special_min_share
           : side == core  ? core_min_share
                           : perimeter_min_share;
  }
  [[nodiscard]] double perimeter_supply_m3_s() const {
    return zone_supply_m3_s[south] + zone_supply_m3_s[north] + zone_supply_m3_s[east] +
           zone_supply_m3_s[west];
  }
  [[nodiscard]] double core_supply_m3_s() const {
    return zone_supply_m3_s[core] + zone_supply_m3_s[special];
  }
  /// Of all air handlers of all storeys together.
  [[nodiscard]] double outdoor_air_m3_s() const {
    return static_cast<double>(storeys) * (perimeter_air.outdoor_m3_s + core_air.outdoor_m3_s);
  }
};

[[nodiscard]] std::string_view to_string(Use use);

}  // namespace recald::simulators
