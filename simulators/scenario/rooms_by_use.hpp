/// The use of a building: rooms, people, hours, set-points.
#pragma once

#include "simulators/building/drawings.hpp"

namespace recald::simulators {

/// Fills in rooms, people and hours for `drawings.use`; the defaults of `Drawings`
/// are a laboratory.
/// @pre the floor's length and width are set
///
/// Figures: people, lights and schedules after ASHRAE 90.1 User's Manual (2004, tables G-B and G-E
/// to G-O), lighting powers by building type after ASHRAE 90.1-2004 table 9.5.1, plugs and storey
/// heights after the DOE commercial reference buildings (Deru et al. 2011, NREL/TP-5500-46861),
/// heat of people after ASHRAE Fundamentals ch. 18 table 1.
void furnish(Drawings& drawings);

}  // namespace recald::simulators
