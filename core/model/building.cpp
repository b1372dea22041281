#include "core/model/building.hpp"

#include <algorithm>

namespace recald::model {

double coil_lift_K(const Building& building) {
  constexpr double kLeast_K = 5.0;
  const double supply_C = building.air ? building.air->supply_temperature_C : 0.0;
  return std::max(building.set_points.cooling_occupied_C - supply_C, kLeast_K);
}

double heat_capacity_J_m2K(MassClass mass) {
  switch (mass) {
    case MassClass::very_light:
      return 80e3;
    case MassClass::light:
      return 110e3;
    case MassClass::medium:
      return 165e3;
    case MassClass::heavy:
      return 260e3;
    case MassClass::very_heavy:
      return 370e3;
  }
  return 165e3;
}

}  // namespace recald::model
