/// EnergyPlus buildings as owners might have them, in two families that share no use, no shape and
/// no air system: one to learn from, one to judge with.
#pragma once

#include <span>

#include "core/random/rng.hpp"
#include "simulators/energyplus/templated_building.hpp"
#include "tests/blind/population/population_kind.hpp"

namespace recald::blind {

/// What a family's buildings may be, besides their uses.
[[nodiscard]] std::span<const simulators::energyplus::Shape> shapes_of(Family family);
[[nodiscard]] std::span<const simulators::energyplus::AirSystem> systems_of(Family family);

/// In any climate; small enough for EnergyPlus to need some seconds a year.
[[nodiscard]] simulators::energyplus::TemplatedBuilding draw_eplus_building(Family family,
                                                                            Rng& rng);

}  // namespace recald::blind
