#include "tests/blind/energyplus/building_draw.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/blind/population/draw_building.hpp"

namespace recald::blind {
namespace {

using simulators::Use;
using simulators::energyplus::AirSystem;
using simulators::energyplus::Shape;

constexpr std::array kLearningShapes{Shape::deep, Shape::bar, Shape::hall};
constexpr std::array kJudgingShapes{Shape::row, Shape::court, Shape::wings};
constexpr std::array kLearningSystems{AirSystem::vav_reheat, AirSystem::fan_coils,
                                      AirSystem::packaged_rooms, AirSystem::water_loop,
                                      AirSystem::ideal_district};
constexpr std::array kJudgingSystems{AirSystem::packaged_vav, AirSystem::outdoor_air_units,
                                     AirSystem::room_heat_pumps, AirSystem::refrigerant_flow};

template <class T>
T draw_one(std::span<const T> values, Rng& rng) {
  return values[rng.below(values.size())];
}

/// One that goes with the use: a warehouse is a hall, nothing else is.
Shape draw_shape(Family family, Use use, Rng& rng) {
  for (;;) {
    const Shape shape = draw_one(shapes_of(family), rng);
    if ((shape == Shape::hall) == (use == Use::warehouse) || family == Family::judging)
      return shape;
  }
}

/// EnergyPlus's time grows with the rooms.
std::size_t most_storeys(Shape shape) {
  switch (shape) {
    case Shape::deep:
      return 2;
    case Shape::bar:
    case Shape::wings:
      return 9;
    case Shape::court:
      return 1;
    case Shape::hall:
    case Shape::row:
      break;
  }
  return 1;
}

}  // namespace

std::span<const Shape> shapes_of(Family family) {
  if (family == Family::learning) return kLearningShapes;
  return kJudgingShapes;
}

std::span<const AirSystem> systems_of(Family family) {
  if (family == Family::learning) return kLearningSystems;
  return kJudgingSystems;
}

simulators::energyplus::TemplatedBuilding draw_eplus_building(Family family, Rng& rng) {
  const Use use = draw_one(uses_of(family), rng);
  simulators::Drawings drawings = draw_building_of(use, rng);
  const double drawn_m2 = drawings.storey_m2();
  const Shape shape = draw_shape(family, use, rng);
  const AirSystem system = draw_one(systems_of(family), rng);
  drawings.storeys = std::min(drawings.storeys, most_storeys(shape));
  drawings.width_m = std::max(drawings.width_m, 12.0);
  drawings.length_m = std::max(drawings.length_m, 1.2 * drawings.width_m);
  if (shape == Shape::bar) drawings.width_m = std::min(drawings.width_m, 18.0);
  // Outdoor air goes with the floor.
  const double grown = drawings.storey_m2() / drawn_m2;
  drawings.perimeter_air.outdoor_m3_s *= grown;
  drawings.core_air.outdoor_m3_s *= grown;
  return {std::move(drawings), shape, system};
}

}  // namespace recald::blind
