#include "core/model/building.hpp"

namespace recald::model {

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
