/// A winter week and a late-summer week of a building without hidden effects, from which an
/// engineer can judge whether the building is realistic.
#pragma once

#include <string>

#include "simulators/scenario/twin.hpp"

namespace recald::simulators {

/// Loads in W/m² of floor area and outdoor temperature, hour by hour; above them each
/// meter's year in kWh/m².
/// @pre the simulated period includes the year `kShowYear`
/// @return an SVG file
[[nodiscard]] std::string week_figure(const Scenario& scenario, const Simulated& simulated,
                                      const metering::LocalCalendar& calendar);

}  // namespace recald::simulators
