/// Standard buildings of each use in each climate, the starting point of every scenario.
#pragma once

#include "simulators/building/drawings.hpp"

namespace recald::simulators {

/// When the building was built: constructions, lights and machines follow the codes of that time.
enum class Vintage { of_1980s, of_2000s, of_2010s };

/// The owner's requirements, from which the rest is sized.
struct Brief {
  Use use = Use::office;
  ClimateKind climate = ClimateKind::mixed;
  std::size_t storeys = 4;
  double length_m = 60.0;
  double width_m = 30.0;
  double window_share = 0.35;
  double skylight_share = 0.0;
  bool heavy = true;
  CoolingPlant cooling = CoolingPlant::district;
  HeatingPlant heating = HeatingPlant::district_water;
  Vintage vintage = Vintage::of_2000s;
};

/// The size and plant common for the use.
[[nodiscard]] Brief typical_brief(Use use);

/// The building's drawings: rooms and hours by use, constructions by climate, air system and plant
/// sized from both (sizing.hpp).
[[nodiscard]] Drawings draw_up(const Brief& brief);

}  // namespace recald::simulators
