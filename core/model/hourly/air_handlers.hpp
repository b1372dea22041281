/// Air handlers, or units in rooms, in one step: mixing, economiser, coils, steam, fans, pumps.
#pragma once

#include "core/model/building.hpp"
#include "core/model/hourly/alteration.hpp"
#include "core/model/hourly/zone_networks.hpp"

namespace recald::model::hourly {

/// Writes the loads of the air side, the flow and the running share into `loads`.
///
/// Scheduled handlers mix in outdoor air; those on call at night recirculate, and their power is
/// proportional to their flow.
///
/// @param heat_capacity_J_m3K  ρ c_p of air.
/// @param running_share        Of all handlers, by schedule.
/// @param zones                Of the whole building.
/// @param latent_W             Moisture of the people in the building, as heat.
/// @see EN 15241:2007, 6.3 and 6.4, for the balances.
void add_air_handlers(const AirSystem& air, double heat_capacity_J_m3K, double running_share,
                      const ZoneTotals& zones, double latent_W, const StepOperation& operation,
                      StepLoads& loads);

/// The same for units in the rooms, which hold each room's set-point by themselves.
///
/// Outdoor air has met the rooms; here an economiser saves cooling, and the coils dry what passes
/// through them. Fans run at one speed by schedule, and on call with the load (that heat is
/// left out); pumps follow the load. A coil takes k (w_room − w_coil) from rooms that outdoor air
/// m_o and people g moisten, where k = Q / (c_p ΔT) passes through it for the sensible load Q:
///     m = k (m_o (w_o − w_coil) + g) / (m_o + k)
/// @param lift_K  ΔT between the rooms and the units' air, by design.
void add_room_units(const AirSystem& air, double lift_K, double heat_capacity_J_m3K,
                    double running_share, const ZoneTotals& zones, double latent_W,
                    const StepOperation& operation, StepLoads& loads);

}  // namespace recald::model::hourly
