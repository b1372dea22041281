#include "simulators/building/air_handler.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr double kActuatorLag_s = 420.0;
constexpr double kWarmestDischarge_C = 33.0;
/// Share of maximum flow that a box may open to when it heats at full valve.
constexpr double kHeatingFlowShare = 0.5;

double proportional(double error_K, double band_K) {
  return std::clamp(error_K / band_K + 0.5, 0.0, 1.0);
}

double supply_setpoint_C(const AirHandlerDesign& design, double outdoor_C) {
  const double coldness = std::clamp((18.0 - outdoor_C) / 13.0, 0.0, 1.0);
  return design.supply_C + coldness * design.supply_reset_K;
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
    // The valve opens first; only beyond half of it does the box add air to carry more heat.
    const double for_heating =
        least + (heating_flow - least) * std::clamp(2.0 * heating_signal_[i] - 1.0, 0.0, 1.0);
    const double for_cooling = least + (1.0 - least) * cooling_signal_[i];
    supplies_[i].kg_s = box.max_kg_s * std::max(for_heating, for_cooling);
    total_kg_s += supplies_[i].kg_s;
  }
  // Boxes never take less than the outdoor air that the space must get.
  const double outdoor_kg_s = command.mode == AirHandlerMode::ventilate
                                  ? command.outdoor_share * design_.outdoor_kg_s
                                  : 0.0;
  const double scale = std::max(1.0, outdoor_kg_s / total_kg_s);
  for (BoxSupply& supply : supplies_) supply.kg_s *= scale;
  work_.supply_kg_s = total_kg_s * scale;
}

double AirHandler::outdoor_flow_kg_s(const AirHandlerCommand& command, const AirState& outdoor,
                                     const AirState& returned, double coil_target_C) const {
  if (command.mode != AirHandlerMode::ventilate) return 0.0;
  const double least_kg_s =
      std::min(work_.supply_kg_s, command.outdoor_share * design_.outdoor_kg_s);
  const bool economise = design_.economiser_limit_C.has_value() &&
                         outdoor.temperature_C < *design_.economiser_limit_C &&
                         outdoor.temperature_C < returned.temperature_C;
  if (!economise) return least_kg_s;
  // As much outdoor air as brings the mixture to what the coil would have to deliver.
  const double wanted_share =
      (returned.temperature_C - coil_target_C) / (returned.temperature_C - outdoor.temperature_C);
  return std::clamp(wanted_share * work_.supply_kg_s, least_kg_s, work_.supply_kg_s);
}

void AirHandler::treat(const AirHandlerCommand& command, const AirState& outdoor,
                       const AirState& returned, double pressure_Pa) {
  work_.fan_W = design_.fan.power_W(work_.supply_kg_s / design_.supply_kg_s);
  work_.fan_to_air_W = work_.fan_W * design_.fan.share_in_airstream;
  const double fan_rise_K =
      work_.fan_to_air_W / (work_.supply_kg_s * heat_capacity_J_kgK(returned));
  const double target_C = supply_setpoint_C(design_, outdoor.temperature_C) - fan_rise_K;

  work_.outdoor_kg_s = outdoor_flow_kg_s(command, outdoor, returned, target_C);
  work_.mixed = mix(outdoor, returned, work_.outdoor_kg_s / work_.supply_kg_s);
  AirState air = work_.mixed;
  const double capacity_W_K = work_.supply_kg_s * heat_capacity_J_kgK(air);
  // A dead band of 1 K keeps preheat and chilled water from working against each other.
  work_.preheat_W =
      std::clamp(capacity_W_K * (target_C - 1.0 - air.temperature_C), 0.0, design_.preheat_W);
  air.temperature_C += work_.preheat_W / capacity_W_K;

  // Recirculating at night to warm up, the chilled-water valve is shut; to cool down, it is open.
  const bool warming =
      command.mode == AirHandlerMode::recirculate &&
      *std::ranges::max_element(heating_signal_) > *std::ranges::max_element(cooling_signal_);
  const CoilWork coil = warming ? CoilWork{air, 0.0, 0.0, 0.0}
                                : cool(design_.coil, air, work_.supply_kg_s, target_C, pressure_Pa);
  work_.cooling_W = coil.total_W;
  work_.condensate_kg_s = coil.condensate_kg_s;
  work_.supply = coil.leaving;
  work_.supply.temperature_C +=
      work_.fan_to_air_W / (work_.supply_kg_s * heat_capacity_J_kgK(coil.leaving));
}

void AirHandler::reheat() {
  work_.reheat_W = 0.0;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    BoxSupply& supply = supplies_[i];
    const double capacity_W_K = supply.kg_s * heat_capacity_J_kgK(work_.supply);
    const double lift_K = std::max(0.0, kWarmestDischarge_C - work_.supply.temperature_C);
    supply.reheat_W = std::min(heating_signal_[i] * lift_K * capacity_W_K, boxes_[i].reheat_W);
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
  position_boxes(command, demands, step_s);
  AirState returned{0.0, 0.0};
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const double share = supplies_[i].kg_s / work_.supply_kg_s;
    returned.temperature_C += share * demands[i].air.temperature_C;
    returned.humidity_kg_kg += share * demands[i].air.humidity_kg_kg;
  }
  treat(command, outdoor, returned, pressure_Pa);
  reheat();
  return work_;
}

}  // namespace recald::simulators
