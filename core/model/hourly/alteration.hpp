/// Changes of an effect, unknown to the drawings, to a run of the hourly model.
///
/// The model calls an alteration at four places and knows nothing else about it. At its neutral
/// values an alteration does not change a single bit of the result.
#pragma once

#include <limits>
#include <span>

#include "core/model/building.hpp"
#include "core/model/drivers.hpp"

namespace recald::model::hourly {

/// The operation of the building in one step, according to drawings, schedules and weather; an
/// alteration may change anything before the zones are solved.
struct StepOperation {
  // Weather at the building.
  double dry_bulb_C;
  double humidity_ratio;  ///< kg/kg
  double wind_m_s;
  double solar_share;  ///< Factor on the sun through and on all surfaces; 1.
  // People and loads.
  double people_share;  ///< Of full occupancy, 0…1.
  double lights_W;
  double plugs_W;
  double exterior_W;  ///< Electricity that does not heat a zone.
  // Controls. "Daytime" rooms are those not served round the clock.
  double daytime_share;  ///< 0: daytime rooms at their night set-points with fans off, 1: at their
                         ///< occupied ones with fans on; between: that share of the rooms.
  double cooling_occupied_C;
  double cooling_unoccupied_C;
  double heating_occupied_C;
  double heating_unoccupied_C;
  // Air handlers.
  double outdoor_air_m3_s;       ///< Least outdoor air while all handlers run.
  double idle_outdoor_air_m3_s;  ///< Drawn in through stopped handlers, into the zone; 0.
  double outdoor_share_min;      ///< Of what handlers and night fans supply, whatever is asked; 0.
  double supply_C;               ///< Supply air temperature.
  double least_flow_m3_s;        ///< Boxes at minimum, with all handlers running.
  double economiser_lockout_C;   ///< -infinity: no economiser.
  double economiser_share;     ///< Of the extra free-cooling flow: the part actually delivered; 1.
  double constant_fan_share;   ///< Of the fans that do not follow the flow; 0.
  double coil_humidity_ratio;  ///< Of air leaving a wet cooling coil, kg/kg.
  double humidifier_kg_kg;     ///< Humidity ratio maintained by steam; 0: none.
  double latent_share;  ///< Of the moisture on the coil: the part that costs chilled water; 1.
  // Envelope.
  double infiltration_factor;  ///< On the leakage flow; 1.
  double zone_gain_W;          ///< Extra sensible heat into the zones, shared by floor area; 0.
  double ground_C;
};

/// The loads of the step before losses and efficiencies, W, and the plant's cost factors.
struct StepLoads {
  double lights_W;
  double plugs_W;
  double exterior_W;
  double fans_W;
  double pumps_W;
  double sensible_cooling_W;
  double latent_cooling_W;
  double zone_heating_W;
  double reheat_W;
  double preheat_W;
  double humidification_W;
  double hot_water_W;
  double base_heat_W;
  // For alterations to read:
  double running_share;           ///< Of all air handlers, 0…1.
  double supply_m3_s;             ///< Of all handlers that run.
  double mean_zone_C;             ///< By floor area.
  double hot_water_litres_share;  ///< Draw of this hour relative to its daily mean, 0…; 1 if even.
  // Plant; factors on the drawings' values.
  double cooling_cost_factor;  ///< On chilled water, or on the chiller's electricity; 1.
  double heating_cost_factor;  ///< On metered heat, or on the heat pump's electricity; 1.
};

/// Days as `DriverHour::day_index` counts them, with the local hour as fraction.
struct DayRange {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();  ///< Not included.
  [[nodiscard]] bool contains(double day) const { return from <= day && day < to; }
};

/// One effect bound to values. Stateless between steps: a run may be repeated, and copies on other
/// threads may run at the same time.
class Alteration {
 public:
  virtual ~Alteration() = default;

  /// Called before the period, after jumps in time and at the ends of `rebuilt`: constructions and
  /// nameplates. Zones must stay the same, because they keep their temperatures.
  virtual void rebuild(Building&) const {}
  /// When the building is as `rebuild` makes it.
  [[nodiscard]] virtual DayRange rebuilt() const { return {}; }
  /// Called in each step, before the zones are solved.
  virtual void operate(const DriverHour&, StepOperation&) const {}
  /// Called in each step, after zones and air handlers, before losses and efficiencies.
  virtual void supply(const Building&, const DriverHour&, const StepOperation&, StepLoads&) const {}
  /// Called at the end with one meter's hourly power as recorded. @param meter  Index among
  /// the model's meters.
  virtual void record(std::span<const DriverHour> /*hours*/, int /*meter*/,
                      std::span<double> /*power_kW*/) const {}
};

}  // namespace recald::model::hourly
