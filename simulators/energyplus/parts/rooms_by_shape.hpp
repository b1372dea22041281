/// Where the rooms of a building lie.
#pragma once

#include <vector>

#include "simulators/building/drawings.hpp"
#include "simulators/energyplus/parts/building_parts.hpp"

namespace recald::simulators::energyplus {

/// Floor plans. Rooms beside each other are as warm as each other: no heat passes between them.
enum class Shape {
  deep,   ///< Rooms along four facades around a core.
  bar,    ///< Rooms to the south and to the north.
  hall,   ///< One high room, and a low one at its western end.
  row,    ///< Units side by side under one roof.
  court,  ///< Eight rooms around a yard.
  wings,  ///< An L: two wings and the corner where they meet.
};

[[nodiscard]] std::string_view to_string(Shape shape);

/// Rooms that are run alike.
struct RoomGroup {
  std::string name;  ///< "Perimeter" or "Core"; where the plan has no core, "House".
  std::vector<Room> rooms;

  [[nodiscard]] double floor_m2() const;  ///< With their multipliers.
  [[nodiscard]] std::vector<std::string> room_names() const;
};

/// One group, or those of the perimeter and the core. Of three storeys and more the middle one
/// stands for all between the lowest and the highest; halls and rows have one storey.
[[nodiscard]] std::vector<RoomGroup> rooms_of(Shape shape, const Drawings& drawings);

}  // namespace recald::simulators::energyplus
