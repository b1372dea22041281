/// Parts of an EnergyPlus model that every building of ours is made of: rooms, constructions,
/// schedules, loads. All names are those of EnergyPlus 25.2's epJSON.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/building/visits.hpp"

namespace recald::simulators::energyplus {

using Json = nlohmann::ordered_json;

inline constexpr std::string_view kVersion = "25.2";

/// A model without rooms: version, 15-minute steps, the whole calendar year, ground temperature,
/// summer time and holidays by the weather file. What it reports is left to whoever runs it.
/// @param ground_C  Below the lowest slab.
[[nodiscard]] Json empty_model(std::string_view building, double ground_C);

/// A schedule with one value, and its name.
std::string add_constant(Json& model, const std::string& name, double value);

/// Shares by local hour.
struct WeeklyShares {
  HourlyShares workday;
  HourlyShares saturday;
  HourlyShares sunday;  ///< And holidays.
};

/// What the coldest day that sizes are made for is like: heated like a working day, but no heat
/// from people and machines is counted on.
enum class ColdDesignDay { working, free };

/// The same week all year, and its name. The hottest design day is a working day.
std::string add_weekly(Json& model, const std::string& name, const WeeklyShares& shares,
                       ColdDesignDay cold = ColdDesignDay::free);

/// Insulation stands in layers without mass, so that a change of it leaves the mass alone.
struct Envelope {
  double wall_insulation_m2K_W;
  double roof_insulation_m2K_W;
  double ground_insulation_m2K_W;
  double window_u_W_m2K;
  double window_shgc;
  double wall_solar_absorptance = 0.6;
  double roof_solar_absorptance = 0.7;
};

/// The constructions that `add_room` refers to.
void add_constructions(Json& model, const Envelope& envelope);

/// In the order of a room's faces.
enum Face : std::size_t { south, north, east, west, ceiling, floor_face };
inline constexpr std::size_t kFaces = 6;

/// What a room's face looks at. `alike`: a room as warm as this one, so no heat passes.
struct Beyond {
  enum class What { outdoors, ground, room, alike } what = What::outdoors;
  std::string room = {};      ///< The room behind it.
  double window_share = 0.0;  ///< Of a facade.
};

struct Room {
  std::string name;
  std::array<double, 2> x_m;  ///< West to east.
  std::array<double, 2> y_m;  ///< South to north.
  std::array<double, 2> z_m;
  std::array<Beyond, kFaces> beyond;
  int multiplier = 1;  ///< So many such rooms there are.

  [[nodiscard]] double floor_m2() const { return (x_m[1] - x_m[0]) * (y_m[1] - y_m[0]); }
  [[nodiscard]] double volume_m3() const { return floor_m2() * (z_m[1] - z_m[0]); }
};

/// A zone and its surfaces. @pre neighbours share whole faces
void add_room(Json& model, const Room& room);

/// People, lights and machines of some rooms.
struct RoomLoads {
  std::string of;  ///< Begins the names of its objects and schedules.
  std::vector<std::string> rooms;
  double people_person_m2;
  double lighting_W_m2;
  double equipment_W_m2;
};

/// One object of each kind for all the rooms: "Offices people", "Offices lights", "Offices
/// equipment"; they follow the schedules "Offices presence", "Offices lights on" and "Offices
/// equipment on", which somebody else adds.
void add_loads(Json& model, const RoomLoads& loads);

/// Outdoor air through cracks. @param flow_m3_s_m2  Per exterior surface, at 4 m/s and 0 K.
void add_infiltration(Json& model, const std::string& of, const std::vector<std::string>& rooms,
                      double flow_m3_s_m2);

/// One thermostat for some rooms, by two constant schedules: "Cooling set-point", "Heating
/// set-point".
void add_thermostats(Json& model, const std::vector<std::string>& rooms, double heating_C,
                     double cooling_C);

}  // namespace recald::simulators::energyplus
