/// Plain buildings of each use in each climate: where every scenario begins.
#pragma once

#include "simulators/building/drawings.hpp"

namespace recald::simulators {

/// What an owner asks an architect for; engineers size the rest from it.
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
};

/// The building's drawings: rooms and hours by use, constructions by climate, air system and plant
/// sized from both (`size_services`).
[[nodiscard]] Drawings draw_up(const Brief& brief);

/// Sizes flows, coils, fans, pumps and meters for the building as drawn. Call again after changing
/// geometry, constructions, rooms or outdoor air.
void size_services(Drawings& drawings);

}  // namespace recald::simulators
