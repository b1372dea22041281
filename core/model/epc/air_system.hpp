/// Air handlers with VAV reheat boxes, quasi-steady.
#pragma once

#include "core/model/building.hpp"

namespace recald::model::epc {

/// What a zone asks of its boxes in one class of hours.
struct ZoneDemand {
  double cooling_load_W;   ///< Sensible heat to remove at the cooling set-point, >= 0.
  double shortage_W;       ///< Heat the zone lacks at the cooling set-point, >= 0.
  double conductance_W_K;  ///< Zone to outdoors and ground, without the air handlers.
  double cooling_set_point_C;
  double heating_set_point_C;
};

/// Limits of a zone's boxes.
struct BoxLimits {
  double supply_C;
  double least_m3_s;  ///< Minimum flow, at least the zone's outdoor air.
  double most_m3_s;   ///< Design flow.
};

struct BoxRates {
  double flow_m3_s;
  double zone_C;     ///< Where the zone settles between its set-points.
  double heating_W;  ///< Reheat and zone heating together.
};

/// Flow follows the cooling load between minimum and design. Air at minimum flow may cool more than
/// the zone needs: then the zone floats down, and only at the heating set-point do the boxes
/// reheat. (Charging reheat from the cooling set-point on, as simple monthly methods do, counts
/// energy that the dead band saves.)
/// @param heat_capacity_J_m3K  ρ c_p of air.
[[nodiscard]] BoxRates box_rates(const BoxLimits& limits, double heat_capacity_J_m3K,
                                 const ZoneDemand& demand);

struct HandlerRates {
  double outdoor_air_share;  ///< Of the supply flow.
  double coil_W;             ///< Sensible cooling: zones, reheat, outdoor air, fan heat.
  double preheat_W;
  double fan_W;
  double pump_W;
};

/// Mixes return and outdoor air and brings it to supply temperature.
/// @param running_share  Of the air handlers: 1 occupied, less at night. Those that run, run as
/// they
///                       do by day: flows and powers scale with their number.
/// @param supply_m3_s    Of all boxes if all ran, > 0.
/// @param return_C       Mean of the zones, weighted by flow.
/// @see EN 15241:2007, 6.3 and 6.4, for the balances.
[[nodiscard]] HandlerRates handler_rates(const AirSystem& system, double heat_capacity_J_m3K,
                                         double running_share, double supply_m3_s, double return_C,
                                         double outdoor_C);

/// Power share of a fan with variable speed at a flow ratio r: 0.0013 + 0.1470 r + 0.9506 r² −
/// 0.0998 r³. @see ANSI/ASHRAE/IES 90.1-2010 user's manual, appendix G, variable speed drive.
[[nodiscard]] double fan_power_share(double flow_ratio);

}  // namespace recald::model::epc
