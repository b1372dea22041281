/// Water loops from a district network to the coils of a building.
#pragma once

#include <string>
#include <vector>

#include "simulators/energyplus/parts/building_parts.hpp"

namespace recald::simulators::energyplus {

/// A coil on a loop. Its water nodes are "NAME water inlet" and "NAME water outlet".
struct LoopCoil {
  std::string type;  ///< "Coil:Heating:Water"
  std::string name;
  double water_m3_s;  ///< Largest flow.
};

struct WaterLoop {
  enum class Of { cooling, heating } of;
  double supply_C;
  double pump_head_Pa;
  std::vector<LoopCoil> coils;
};

/// "Chilled water loop" or "Hot water loop": district plant, pump with variable speed, coils in
/// parallel, a bypass. The schedule "Chilled water temperature" or "Hot water temperature" sets the
/// supply.
void add_water_loop(Json& model, const WaterLoop& loop);

}  // namespace recald::simulators::energyplus
