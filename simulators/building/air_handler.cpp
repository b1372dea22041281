#include "simulators/building/air_handler.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr double kActuatorLag_s = 420.0;
constexpr double kWarmestDischarge_C = 33.0;
/// Share of maximum flow to which a box may open when its heating valve is fully open.
constexpr double kHeatingFlowShare = 0.5;

/// The air temperature that the coil must reach: its set-point, or lower if that is
/// needed for drying.
double coil_target_C(const AirOperation& operation, const AirState& air, double setpoint_C,
                     double pressure_Pa) {
  if (!operation.dry_to_C) return setpoint_C;
  const double dew_C = dew_point_C(vapour_pressure_Pa(air.humidity_kg_kg, pressure_Pa));
  return dew_C > *operation.dry_to_C ? std::min(setpoint_C, *operation.dry_to_C) : setpoint_C;
}

double proportional(double error_K, double band_K) {
  return std::clamp(error_K / band_K + 0.5, 0.0, 1.0);
}

}  // namespace

double Fan::power_W(double flow_share) const {
  if (flow_share <= 0.0) return 0.0;
  return design_W * (idle_share + (1.0 - idle_share) * std::pow(flow_share, exponent));
}

AirHandler::AirHandler(const AirHandlerDesign& design, std::vector<BoxDesign> boxes)
    : design_(design),
      boxes_(std::move(boxes)),
      cooling_signal_(boxes_.size(), 0.0),
      heating_signal_(boxes_.size(), 0.0),
      supplies_(boxes_.size()) {}

double AirHandler::supply_setpoint_C(const AirOperation& operation, double outdoor_C) const {
  const double coldness = std::clamp((18.0 - outdoor_C) / 13.0, 0.0, 1.0);
  return design_.supply_C + coldness * design_.supply_reset_K * operation.supply_reset_share +
         operation.supply_shift_K;
}

double AirHandler::fan_W(const AirHandlerCommand& command) const {
  const double flow_share = work_.supply_kg_s / design_.supply_kg_s / command.run_share;
  const double following_W = design_.fan.power_W(flow_share);
  // A fan that does not slow down works against the boxes' dampers.
  const double one_W = following_W + (1.0 - command.operation.fan_follows_flow) *
                                         (design_.fan.design_W - following_W);
  return command.run_share * one_W;
}

double AirHandler::asked_outdoor_kg_s(const AirHandlerCommand& command) const {
  return command.run_share * command.outdoor_share * command.operation.outdoor_factor *
         design_.outdoor_kg_s;
}

void AirHandler::position_boxes(const AirHandlerCommand& command,
                                std::span<const BoxDemand> demands, double step_s) {
  const double follow = 1.0 - std::exp(-step_s / kActuatorLag_s);
  double total_kg_s = 0.0;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const BoxDemand& demand = demands[i];
    const BoxDesign& box = boxes_[i];
    const double cooling = proportional(demand.felt_C - demand.cooling_C, demand.band_K);
    const double heating = proportional(demand.heating_C - demand.felt_C, demand.band_K);
    cooling_signal_[i] += follow * (cooling - cooling_signal_[i]);
    heating_signal_[i] += follow * (heating - heating_signal_[i]);
    const double least = std::min(1.0, box.min_share * command.min_flow_share);
    const double heating_flow = std::max(least, kHeatingFlowShare);
    // The valve opens first; only above half its stroke does the box add air to carry more heat.
    const double for_heating =
        least + (heating_flow - least) * std::clamp(2.0 * heating_signal_[i] - 1.0, 0.0, 1.0);
    const double for_cooling = least + (1.0 - least) * cooling_signal_[i];
    supplies_[i].kg_s = command.run_share * box.max_kg_s * std::max(for_heating, for_cooling);
    total_kg_s += supplies_[i].kg_s;
  }
  // Boxes never take less than the outdoor air that the space requires.
  const double outdoor_kg_s =
      command.mode == AirHandlerMode::ventilate ? asked_outdoor_kg_s(command) : 0.0;
  const double scale = std::max(1.0, outdoor_kg_s / total_kg_s);
  for (BoxSupply& supply : supplies_) supply.kg_s *= scale;
  work_.supply_kg_s = total_kg_s * scale;
}

double AirHandler::outdoor_flow_kg_s(const AirHandlerCommand& command, const AirState& outdoor,
                                     const AirState& returned, double coil_target_C) const {
  const AirOperation& operation = command.operation;
  const double leak_kg_s = operation.damper_leak_share * work_.supply_kg_s;
  if (command.mode != AirHandlerMode::ventilate) return leak_kg_s;
  const double least_kg_s =
      std::max(leak_kg_s, std::min(work_.supply_kg_s, asked_outdoor_kg_s(command)));
  const bool economise =
      design_.economiser_limit_C.has_value() &&
      outdoor.temperature_C < *design_.economiser_limit_C + operation.economiser_shift_K &&
      outdoor.temperature_C < returned.temperature_C;
  if (!economise) return least_kg_s;
  // Enough outdoor air to bring the mixture to the temperature that the coil would have to deliver.
  const double wanted_share =
      (returned.temperature_C - coil_target_C) / (returned.temperature_C - outdoor.temperature_C);
  const double wanted_kg_s =
      std::clamp(wanted_share * work_.supply_kg_s, least_kg_s, work_.supply_kg_s);
  return least_kg_s + operation.economiser_share * (wanted_kg_s - least_kg_s);
}

void AirHandler::treat(const AirHandlerCommand& command, const AirState& outdoor,
                       const AirState& returned, double pressure_Pa) {
  const AirOperation& operation = command.operation;
  work_.fan_W = fan_W(command);
  work_.fan_to_air_W = work_.fan_W * design_.fan.share_in_airstream;
  const double fan_rise_K =
      work_.fan_to_air_W / (work_.supply_kg_s * heat_capacity_J_kgK(returned));
  const double target_C = supply_setpoint_C(operation, outdoor.temperature_C) - fan_rise_K;

  work_.outdoor_kg_s = outdoor_flow_kg_s(command, outdoor, returned, target_C);
  work_.mixed = mix(outdoor, returned, work_.outdoor_kg_s / work_.supply_kg_s);
  AirState air = work_.mixed;
  const double capacity_W_K = work_.supply_kg_s * heat_capacity_J_kgK(air);
  // A dead band of 1 K keeps preheat and chilled water from working against each other.
  work_.preheat_W =
      std::clamp(capacity_W_K * (target_C - 1.0 - air.temperature_C), 0.0, design_.preheat_W);
  air.temperature_C += work_.preheat_W / capacity_W_K;

  // While warming up at night the chilled-water valve is shut; while cooling down it is open.
  const bool warming =
      command.mode == AirHandlerMode::recirculate &&
      *std::ranges::max_element(heating_signal_) > *std::ranges::max_element(cooling_signal_);
  const double coil_C = coil_target_C(operation, air, target_C, pressure_Pa);
  const CoilWork coil = warming ? CoilWork{air, 0.0, 0.0, 0.0}
                                : cool(design_.coil, air, work_.supply_kg_s, coil_C, pressure_Pa);
  work_.cooling_W = coil.total_W;
  work_.condensate_kg_s = coil.condensate_kg_s;
  work_.supply = coil.leaving;
  work_.supply.temperature_C +=
      work_.fan_to_air_W / (work_.supply_kg_s * heat_capacity_J_kgK(coil.leaving));
  humidify(operation);
}

void AirHandler::humidify(const AirOperation& operation) {
  const double missing = operation.humidify_to_kg_kg - work_.supply.humidity_kg_kg;
  if (missing <= 0.0) return;
  // Steam carries its own heat of evaporation: the air hardly warms.
  work_.humidifier_W = work_.supply_kg_s * missing * (kEvaporation_J_kg + kWaterHeat_J_kgK * 90.0);
  work_.supply.humidity_kg_kg = operation.humidify_to_kg_kg;
}

/// Fans push outdoor air through open boxes, without heating or cooling it.
void AirHandler::purge(const AirHandlerCommand& command, const AirState& outdoor) {
  work_.supply_kg_s = 0.0;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    supplies_[i].kg_s = command.run_share * boxes_[i].max_kg_s;
    work_.supply_kg_s += supplies_[i].kg_s;
  }
  work_.outdoor_kg_s = work_.supply_kg_s;
  work_.fan_W = fan_W(command);
  work_.fan_to_air_W = work_.fan_W * design_.fan.share_in_airstream;
  work_.mixed = work_.supply = outdoor;
  work_.supply.temperature_C +=
      work_.fan_to_air_W / (work_.supply_kg_s * heat_capacity_J_kgK(outdoor));
  for (BoxSupply& supply : supplies_) {
    supply.air = work_.supply;
    supply.reheat_W = 0.0;
  }
}

void AirHandler::reheat(double leak_share) {
  work_.reheat_W = 0.0;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    BoxSupply& supply = supplies_[i];
    const double capacity_W_K = supply.kg_s * heat_capacity_J_kgK(work_.supply);
    const double lift_K = std::max(0.0, kWarmestDischarge_C - work_.supply.temperature_C);
    const double wanted_W =
        std::min(heating_signal_[i] * lift_K * capacity_W_K, boxes_[i].reheat_W);
    supply.reheat_W = std::max(wanted_W, leak_share * boxes_[i].reheat_W);
    supply.air = work_.supply;
    supply.air.temperature_C += supply.reheat_W / capacity_W_K;
    work_.reheat_W += supply.reheat_W;
  }
}

const AirHandlerWork& AirHandler::advance(const AirHandlerCommand& command,
                                          std::span<const BoxDemand> demands,
                                          const AirState& outdoor, double pressure_Pa,
                                          double step_s) {
  assert(demands.size() == boxes_.size());
  work_ = AirHandlerWork{};
  if (command.mode == AirHandlerMode::off) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      supplies_[i] = BoxSupply{0.0, demands[i].air, 0.0};
      cooling_signal_[i] = heating_signal_[i] = 0.0;
    }
    return work_;
  }
  if (command.mode == AirHandlerMode::purge) {
    std::ranges::fill(cooling_signal_, 0.0);
    std::ranges::fill(heating_signal_, 0.0);
    purge(command, outdoor);
    return work_;
  }
  position_boxes(command, demands, step_s);
  AirState returned{0.0, 0.0};
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const double share = supplies_[i].kg_s / work_.supply_kg_s;
    returned.temperature_C += share * demands[i].air.temperature_C;
    returned.humidity_kg_kg += share * demands[i].air.humidity_kg_kg;
  }
  treat(command, outdoor, returned, pressure_Pa);
  reheat(command.operation.reheat_leak_share);
  return work_;
}

}  // namespace recald::simulators
