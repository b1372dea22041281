#include "simulators/building/drawings.hpp"

namespace recald::simulators {

double Drawings::zone_m2(std::size_t side) const {
  switch (side) {
    case south:
    case north:
      return length_m * perimeter_depth_m;
    case east:
    case west:
      return (width_m - 2 * perimeter_depth_m) * perimeter_depth_m;
    case core:
      return (1.0 - special_share_of_core) * core_and_special_m2();
    default:
      return special_share_of_core * core_and_special_m2();
  }
}

std::string_view to_string(Use use) {
  switch (use) {
    case Use::laboratory:
      return "laboratory";
    case Use::office:
      return "office";
    case Use::school:
      return "school";
    case Use::shop:
      return "shop";
    case Use::hotel:
      return "hotel";
    case Use::clinic:
      return "clinic";
    case Use::warehouse:
      return "warehouse";
    case Use::restaurant:
      return "restaurant";
    case Use::gym:
      return "gym";
  }
  return "";
}

}  // namespace recald::simulators
