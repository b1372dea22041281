/// Sizes the services of a building as drawn.
#pragma once

#include "simulators/building/drawings.hpp"

namespace recald::simulators {

/// Sizes flows, coils, fans, pumps and meters for the building as drawn. Call again after changing
/// geometry, constructions, rooms or outdoor air.
void size_services(Drawings& drawings);

/// The nearest multiple of the step, as in ordinary rounding.
[[nodiscard]] double in_steps(double value, double step);

}  // namespace recald::simulators
