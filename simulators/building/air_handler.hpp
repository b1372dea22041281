/// A variable-air-volume air handler with its terminal boxes: mixing, preheat, cooling, fan,
/// reheat.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "simulators/building/cooling_coil.hpp"
#include "simulators/building/operation.hpp"

namespace recald::simulators {

struct Fan {
  double design_W;    ///< Supply, return and exhaust of one air handler at design flow.
  double idle_share;  ///< Of design power as flow goes to zero (static pressure is maintained).
  double exponent;    ///< power = idle + (1 − idle)·flow^exponent.
  double share_in_airstream;  ///< Of the power: the part that warms the supply air.

  [[nodiscard]] double power_W(double flow_share) const;
};

struct AirHandlerDesign {
  double supply_kg_s;
  double outdoor_kg_s;    ///< Kept by an airflow station while ventilating.
  double supply_C;        ///< Leaving the fan.
  double supply_reset_K;  ///< Added when it is cold outside (full at 5 degC, none at 18 degC).
  double preheat_W;       ///< Capacity.
  CoolingCoil coil;
  Fan fan;
  /// No extra outdoor air is taken above this dry bulb. Absent: there is no economiser, as ASHRAE
  /// 90.1 allows in climate zone 3A.
  std::optional<double> economiser_limit_C;
};

struct BoxDesign {
  double max_kg_s;
  double min_share;  ///< Of the maximum, while ventilating.
  double reheat_W;   ///< Capacity.
};

/// The state of a box's zone.
struct BoxDemand {
  AirState air;      ///< Returned to the air handler.
  double felt_C;     ///< At the thermostat.
  double cooling_C;  ///< Centre of the cooling band.
  double heating_C;  ///< Centre of the heating band.
  double band_K;     ///< Proportional band of either.
};

enum class AirHandlerMode {
  off,
  ventilate,    ///< Outdoor air as designed, supply air at its set-point.
  recirculate,  ///< Start-up and night cycle: outdoor damper shut.
  purge,        ///< Untreated outdoor air, boxes open, coils shut.
};

struct AirHandlerCommand {
  AirHandlerMode mode;
  double outdoor_share = 1.0;   ///< Of the design outdoor air, while ventilating.
  double min_flow_share = 1.0;  ///< Scales the boxes' minimum flow.
  double run_share = 1.0;  ///< Of the handler: applies equally to its boxes, outdoor air and fans.
  AirOperation operation = {};
};

struct BoxSupply {
  double kg_s = 0.0;
  AirState air{20.0, 0.008};
  double reheat_W = 0.0;
};

struct AirHandlerWork {
  double cooling_W = 0.0;
  double preheat_W = 0.0;
  double reheat_W = 0.0;
  double fan_W = 0.0;
  double fan_to_air_W = 0.0;
  double condensate_kg_s = 0.0;
  double humidifier_W = 0.0;  ///< Heat of the added steam.
  double supply_kg_s = 0.0;
  double outdoor_kg_s = 0.0;
  AirState mixed{20.0, 0.008};
  AirState supply{20.0, 0.008};
};

class AirHandler {
 public:
  AirHandler(const AirHandlerDesign& design, std::vector<BoxDesign> boxes);

  /// Advances one step: dampers and valves follow the thermostats with a lag of minutes,
  /// then the air is treated. `supplies()` returns what each box delivers. @pre
  /// demands.size() == number of boxes
  const AirHandlerWork& advance(const AirHandlerCommand& command,
                                std::span<const BoxDemand> demands, const AirState& outdoor,
                                double pressure_Pa, double step_s);

  [[nodiscard]] const std::vector<BoxSupply>& supplies() const { return supplies_; }
  [[nodiscard]] const AirHandlerDesign& design() const { return design_; }

 private:
  void position_boxes(const AirHandlerCommand& command, std::span<const BoxDemand> demands,
                      double step_s);
  [[nodiscard]] double outdoor_flow_kg_s(const AirHandlerCommand& command, const AirState& outdoor,
                                         const AirState& returned, double coil_target_C) const;
  void purge(const AirHandlerCommand& command, const AirState& outdoor);
  [[nodiscard]] double supply_setpoint_C(const AirOperation& operation, double outdoor_C) const;
  [[nodiscard]] double asked_outdoor_kg_s(const AirHandlerCommand& command) const;
  [[nodiscard]] double fan_W(const AirHandlerCommand& command) const;
  void humidify(const AirOperation& operation);
  void treat(const AirHandlerCommand& command, const AirState& outdoor, const AirState& returned,
             double pressure_Pa);
  void reheat(double leak_share);

  AirHandlerDesign design_;
  std::vector<BoxDesign> boxes_;
  std::vector<double> cooling_signal_;  ///< 0…1, lagged.
  std::vector<double> heating_signal_;  ///< 0…1, lagged.
  std::vector<BoxSupply> supplies_;
  AirHandlerWork work_;
};

}  // namespace recald::simulators
