/// An air handler with variable air volume and reheat, all its sizes given.
#pragma once

#include <string>
#include <vector>

#include "simulators/energyplus/parts/plant_loop.hpp"

namespace recald::simulators::energyplus {

/// The box of a room.
struct Terminal {
  std::string room;
  double supply_m3_s;    ///< Largest flow.
  double minimum_share;  ///< Of it; the box reheats at this flow.
  double reheat_W;
};

struct AirHandler {
  std::string name;
  double supply_C;
  double preheat_C;  ///< The mixed air is warmed to this before it is cooled.
  double outdoor_m3_s;
  std::string outdoor_schedule;  ///< Multiplies that flow.
  double fan_pressure_Pa;
  std::vector<Terminal> terminals;

  [[nodiscard]] double supply_m3_s() const;
};

/// Temperatures that the coils are laid out for.
struct WaterDesign {
  double chilled_C = 6.7;
  double hot_C = 70.0;
};

struct HandlerCoils {
  LoopCoil cooling;
  std::vector<LoopCoil> heating;  ///< Preheat, then reheat in the order of the terminals.
};

/// Outdoor air in a fixed flow, without an economiser; preheat; fan; cooling coil; a box with
/// reheat in each room. It runs day and night. The schedule "NAME supply temperature" sets the air.
/// @return the coils, which some loop must serve.
HandlerCoils add_air_handler(Json& model, const AirHandler& handler, const WaterDesign& water);

}  // namespace recald::simulators::energyplus
