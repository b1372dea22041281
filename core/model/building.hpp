/// A building as its drawings and nameplates describe it: the nominal model.
///
/// All building models read this description; calibration parameters change copies of it.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "core/model/schedule.hpp"
#include "core/weather/sun.hpp"

namespace recald::model {

enum class SurfaceKind { wall, roof, window, ground };

/// A part of the envelope. Areas are outer dimensions, m².
struct Surface {
  std::string name;
  SurfaceKind kind;
  double area_m2;
  double u_W_m2K;
  weather::Orientation orientation;  ///< Not used for ground.
  double solar_absorptance = 0.6;    ///< Wall, roof.
  double emissivity = 0.9;           ///< Wall, roof, window: long-wave.
  double shgc = 0.0;                 ///< Window: solar heat gain coefficient at normal incidence.
  double frame_fraction = 0.0;       ///< Window.
  double shading_factor = 1.0;       ///< Window: share of the sun that reaches the glass.
};

/// Internal heat capacity per floor area, ISO 13790:2008 table 12.
enum class MassClass { very_light, light, medium, heavy, very_heavy };
[[nodiscard]] double heat_capacity_J_m2K(MassClass mass);

struct Use {
  double occupancy_person_m2 = 0.0;  ///< People per floor area when fully occupied.
  double sensible_W_person = 75.0;
  double latent_W_person = 55.0;
  double lighting_W_m2 = 0.0;    ///< Installed; splits the measured profile, see profile/.
  double plugs_W_m2 = 0.0;       ///< Installed; likewise.
  double exterior_kW = 0.0;      ///< Electricity that does not heat a zone.
  double zone_heat_share = 0.9;  ///< Of lights and plugs.
  double lights_scale = 1.0;     ///< On the lights that were read off the electricity meter …
  double plugs_scale = 1.0;      ///< … and on the plugs: 1 until a measure changes them.
  // Where gains arise; only the hourly model uses these.
  double closet_share = 0.0;   ///< Of the plugs' heat: in closets that are always kept cool.
  double gains_to_core = 0.0;  ///< Of the perimeter's even share of gains: arises in the core.
};

/// Indoor temperatures that the controls maintain, °C. Occupied hours: workdays from…to.
struct SetPoints {
  double cooling_occupied_C = 24.0;
  double cooling_unoccupied_C = 28.0;
  double heating_occupied_C = 21.0;
  double heating_unoccupied_C = 16.0;
  int occupied_from_hour = 7;
  int occupied_to_hour = 19;
  bool saturday_occupied = false;
  bool sunday_occupied = false;  ///< And on holidays.
  // How far the plant's day differs from that timetable, since site files give only whole hours.
  // Only the hourly model uses these.
  double start_early_h = 0.0;   ///< Negative: it starts later.
  double stop_late_h = 0.0;     ///< Negative: it stops earlier.
  double warm_up_h = 0.0;       ///< Time in which the heating set-point rises after the start.
  double closed_start_h = 0.0;  ///< Time after the start with outdoor-air dampers shut.
};

/// Days of every year on which the building runs differently: a school's summer, a
/// boiler that is off.
struct Season {
  std::chrono::month_day first;  ///< May be later in the year than `last`: over New Year.
  std::chrono::month_day last;   ///< Inclusive.
  std::optional<HourlySchedule> occupied_fraction;  ///< Absent: the same as all year.
  bool closed = false;  ///< Set-points and fans keep their unoccupied values all day.
  bool heating = true;  ///< False: rooms and supply air are not heated, but hot water still is.
  bool cooling = true;

  [[nodiscard]] bool has_own_use() const { return closed || occupied_fraction; }

  [[nodiscard]] bool contains(metering::Day day) const {
    const std::chrono::month_day date{day.month(), day.day()};
    const bool after = first <= date;
    const bool before = date <= last;
    return first <= last ? after && before : after || before;
  }
};

/// Air handlers with VAV reheat as one system, or units in the rooms. Absent in a building without.
struct AirSystem {
  /// False: units in the rooms (fan coils, packaged units, room heat pumps, ideal air). Each room
  /// is heated or cooled, never both; outdoor air meets the room; fans run at one speed.
  bool has_reheat_boxes = true;
  double outdoor_air_m3_s = 0.0;  ///< Total of all air handlers while occupied.
  /// Share of the air handlers that runs round the clock (laboratories); 0: fans are off when
  /// unoccupied. The rooms they serve keep their daytime set-points.
  double outdoor_air_unoccupied_fraction = 0.0;
  double supply_flow_design_m3_s = 0.0;
  double supply_flow_min_m3_s = 0.0;  ///< Boxes closed to their minimum, occupied.
  double supply_temperature_C = 13.0;
  double supply_reset_K = 0.0;  ///< Supply air is warmer by this on cold days, 5 °C and below.
  double fan_design_kW = 0.0;   ///< Supply and return fans at design flow.
  double pump_design_kW = 0.0;  ///< Chilled and hot water pumps at design flow.
  double heat_recovery = 0.0;   ///< Sensible effectiveness, 0…1.
  std::optional<double> economiser_lockout_C;  ///< No free cooling above it; absent: none at all.
  std::optional<double> humidification_kg_kg;  ///< Humidity ratio kept by steam; absent: none.
  /// Share of the fans' design power used while rooms are heated and the handlers are off by
  /// schedule; 0: heaters in the rooms do it. Only the hourly model uses it.
  double night_fan_share = 0.0;
  /// Share of the design power that fans keep as flow goes to zero, because the pressure in the
  /// ducts is kept up, over the curve of EnergyPlus's defaults. Only the hourly model uses it.
  double fan_idle_share = 0.0;
};

/// Hot water at the taps.
struct HotWater {
  double volume_m3_day = 0.0;
  double temperature_C = 55.0;
  double mains_C = 12.0;           ///< Yearly mean of the cold water.
  double mains_amplitude_K = 0.0;  ///< Half the swing over the year.
  double efficiency = 0.9;         ///< Distribution and generation together.
};

/// Leaving water at which chillers meet their nameplates (AHRI 550/590: 44 °F).
inline constexpr double kRatedChilledWater_C = 6.67;

struct Building {
  double floor_area_m2 = 0.0;
  int storeys = 1;
  double storey_height_m = 3.0;
  double heat_capacity_J_m2K = 165e3;
  // How the rooms store that heat; only the hourly model uses these.
  double mass_coupling = 1.0;    ///< Between mass and inner surfaces, relative to the standard's.
  double core_mass_share = 1.0;  ///< Capacity per floor of rooms without outer walls, as a factor.
  double air_capacity_J_m2K = 0.0;  ///< Air and furniture: follow the air at once, not the mass.
  std::vector<Surface> surfaces;
  Use use;
  HourlySchedule occupied_fraction;
  /// The first season that contains a day and has its own use applies. The plant is off if any
  /// of them says so.
  std::vector<Season> seasons;
  SetPoints set_points;
  double leakage_cm2_m2 = 1.0;    ///< Effective leakage area at 4 Pa per exterior area.
  double ventilation_m3_s = 0.0;  ///< Outdoor air directly to the zone, without an air system.
  std::optional<AirSystem> air;
  double heating_loss_fraction = 0.0;
  double heating_efficiency = 1.0;  ///< Boiler or heat exchanger, metered energy to heat.
  double cooling_loss_fraction = 0.0;
  std::optional<double> chiller_cop;  ///< Absent: district chilled water.
  /// Increase of the chiller's electricity per cooling for each K of outdoor wet bulb. Only the
  /// hourly model uses it.
  double chiller_lift_per_K = 0.0;
  /// Water that leaves the chiller. A kelvin more spares it as much as a kelvin less of wet bulb.
  /// Only the hourly model uses it, of a chiller that feels the wet bulb.
  double chilled_water_C = kRatedChilledWater_C;
  /// What pumps, tower and compressors of an own chiller take whenever it runs, over what follows
  /// its load. Only the hourly model uses it.
  double cooling_idle_kW = 0.0;
  HotWater hot_water;
  double base_heat_kW = 0.0;  ///< Heat used at all hours that serves no zone.
  double ground_temperature_C = 12.0;
};

/// Between rooms and the air of units in them, by design; at least 5 K. Nameplates refer to it.
[[nodiscard]] double coil_lift_K(const Building& building);

/// True if rooms get cold air from handlers through boxes that reheat it.
[[nodiscard]] inline bool has_reheat_boxes(const Building& building) {
  return building.air && building.air->has_reheat_boxes;
}

}  // namespace recald::model
