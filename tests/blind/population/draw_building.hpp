/// Buildings as an owner might have them, and site files as their engineer might write them.
#pragma once

#include "core/random/rng.hpp"
#include "simulators/scenario/archetypes.hpp"

namespace recald::blind {

/// A building of this use with the sizes, plants and age that such buildings have, in any climate.
[[nodiscard]] simulators::Drawings draw_building_of(simulators::Use use, Rng& rng);

/// The drawings as their engineer remembers them: constructions, densities and nameplates off by
/// some ten per cent, rounded as people round; geometry, plant and hours are known.
[[nodiscard]] simulators::Drawings misremembered(simulators::Drawings drawings, Rng& rng);

}  // namespace recald::blind
