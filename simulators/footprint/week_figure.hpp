/// A week in winter and one in late summer of a building without hidden effects, for an engineer
/// to judge whether such a building could stand somewhere.
#pragma once

#include <string>

#include "simulators/scenario/twin.hpp"

namespace recald::simulators {

/// Loads in W/m² of floor and outdoor temperature, hour by hour; above them each meter's year in
/// kWh/m².
/// @pre the simulated period includes the year `kShowYear`
/// @return an SVG file
[[nodiscard]] std::string week_figure(const Scenario& scenario, const Simulated& simulated,
                                      const metering::LocalCalendar& calendar);

}  // namespace recald::simulators
