/// Buildings of many kinds as EnergyPlus models: rooms and loads from drawings, air systems and
/// plants by EnergyPlus's own templates, which ExpandObjects turns into objects.
///
/// @see EnergyPlus 25.2, Input Output Reference, "Group – HVAC Templates".
#pragma once

#include "simulators/energyplus/parts/rooms_by_shape.hpp"

namespace recald::simulators::energyplus {

enum class AirSystem {
  vav_reheat,         ///< Central air with boxes that reheat; chilled and hot water.
  fan_coils,          ///< In each room, with its own outdoor air.
  packaged_rooms,     ///< A unit a room: direct expansion, gas or hot water.
  water_loop,         ///< Heat pumps on one loop between boiler and tower.
  ideal_district,     ///< As much warm and cool air as is needed, from the district.
  packaged_vav,       ///< Central units with direct expansion, boxes with hot water.
  outdoor_air_units,  ///< Fan coils beside a system for outdoor air alone.
  room_heat_pumps,    ///< Air-source, through the wall.
  refrigerant_flow,   ///< One outdoor unit, a cassette in each room.
};

[[nodiscard]] std::string_view to_string(AirSystem system);

struct TemplatedBuilding {
  Drawings drawings;
  Shape shape;
  AirSystem system;
};

/// Sizes are left to EnergyPlus, which needs design days and ExpandObjects for them. Schedules
/// begin with the name of the group of rooms that they are of: "House fans run", "Core plugs on".
[[nodiscard]] Json templated_model(const TemplatedBuilding& building);

/// The coldest and the hottest hours of a year, for sizing.
struct DesignHours {
  double heating_C;  ///< Colder in 0.4 % of the hours.
  double cooling_C;  ///< Warmer in 0.4 % of them.
  double cooling_wet_bulb_C;
  double pressure_Pa;
  Place place;
  double zone_h;  ///< Standard time's offset from UTC.
};

void add_design_days(Json& model, const DesignHours& hours);

}  // namespace recald::simulators::energyplus
