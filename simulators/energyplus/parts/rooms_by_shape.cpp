#include "simulators/energyplus/parts/rooms_by_shape.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators::energyplus {
namespace {

/// A room of a storey as seen from above.
struct Plan {
  std::string name;
  std::array<double, 2> x_m;
  std::array<double, 2> y_m;
  std::vector<Face> facades;
  bool is_core = false;
};

std::vector<Plan> deep_plan(const Drawings& drawings) {
  const double length_m = drawings.length_m;
  const double width_m = drawings.width_m;
  const double depth_m = std::min(drawings.perimeter_depth_m, width_m / 3.0);
  const std::array<double, 2> between_m{depth_m, width_m - depth_m};
  return {{"south", {0.0, length_m}, {0.0, depth_m}, {south, east, west}},
          {"north", {0.0, length_m}, {width_m - depth_m, width_m}, {north, east, west}},
          {"east", {length_m - depth_m, length_m}, between_m, {east}},
          {"west", {0.0, depth_m}, between_m, {west}},
          {"core", {depth_m, length_m - depth_m}, between_m, {}, true}};
}

std::vector<Plan> bar_plan(const Drawings& drawings) {
  const double middle_m = 0.5 * drawings.width_m;
  return {{"south", {0.0, drawings.length_m}, {0.0, middle_m}, {south, east, west}},
          {"north", {0.0, drawings.length_m}, {middle_m, drawings.width_m}, {north, east, west}}};
}

std::vector<Plan> hall_plan(const Drawings& drawings) {
  constexpr double kAnnexe_m = 8.0;
  return {{"hall",
           {kAnnexe_m, kAnnexe_m + drawings.length_m},
           {0.0, drawings.width_m},
           {south, north, east}},
          {"annexe", {0.0, kAnnexe_m}, {0.0, drawings.width_m}, {south, north, west}}};
}

std::vector<Plan> row_plan(const Drawings& drawings) {
  constexpr double kUnit_m = 14.0;
  const auto units =
      static_cast<std::size_t>(std::clamp(std::round(drawings.length_m / kUnit_m), 3.0, 6.0));
  const double unit_m = drawings.length_m / static_cast<double>(units);
  std::vector<Plan> plans;
  for (std::size_t i = 0; i < units; ++i) {
    const auto at = static_cast<double>(i);
    Plan plan{"unit " + std::to_string(i + 1),
              {at * unit_m, (at + 1.0) * unit_m},
              {0.0, drawings.width_m},
              {south, north}};
    if (i == 0) plan.facades.push_back(west);
    if (i + 1 == units) plan.facades.push_back(east);
    plans.push_back(plan);
  }
  return plans;
}

/// Corners own both of their facades.
std::vector<Plan> court_plan(const Drawings& drawings) {
  const double length_m = drawings.length_m;
  const double width_m = drawings.width_m;
  const double depth_m = std::min(12.0, 0.3 * width_m);
  const std::array<double, 2> first_m{0.0, depth_m};
  const std::array<double, 2> x_m{depth_m, length_m - depth_m};
  const std::array<double, 2> y_m{depth_m, width_m - depth_m};
  const std::array<double, 2> last_x_m{length_m - depth_m, length_m};
  const std::array<double, 2> last_y_m{width_m - depth_m, width_m};
  return {
      {"south-west", first_m, first_m, {south, west}},   {"south", x_m, first_m, {south, north}},
      {"south-east", last_x_m, first_m, {south, east}},  {"east", last_x_m, y_m, {east, west}},
      {"north-east", last_x_m, last_y_m, {north, east}}, {"north", x_m, last_y_m, {south, north}},
      {"north-west", first_m, last_y_m, {north, west}},  {"west", first_m, y_m, {east, west}}};
}

std::vector<Plan> wings_plan(const Drawings& drawings) {
  const double depth_m = std::max(0.45 * drawings.width_m, 8.0);
  return {{"corner", {0.0, depth_m}, {0.0, depth_m}, {south, west}},
          {"east wing", {depth_m, drawings.length_m}, {0.0, depth_m}, {south, north, east}},
          {"north wing", {0.0, depth_m}, {depth_m, drawings.width_m}, {north, east, west}}};
}

std::vector<Plan> plans_of(Shape shape, const Drawings& drawings) {
  switch (shape) {
    case Shape::deep:
      return deep_plan(drawings);
    case Shape::bar:
      return bar_plan(drawings);
    case Shape::hall:
      return hall_plan(drawings);
    case Shape::row:
      return row_plan(drawings);
    case Shape::court:
      return court_plan(drawings);
    case Shape::wings:
      break;
  }
  return wings_plan(drawings);
}

bool is_low(Shape shape) { return shape == Shape::hall || shape == Shape::row; }

Room room_at(const Plan& plan, const Drawings& drawings, std::size_t storey, std::size_t storeys,
             double height_m) {
  using What = Beyond::What;
  const auto level = static_cast<double>(storey);
  Room room{.name = "Storey " + std::to_string(storey + 1) + " " + plan.name,
            .x_m = plan.x_m,
            .y_m = plan.y_m,
            .z_m = {level * height_m, (level + 1.0) * height_m},
            .beyond = {}};
  room.beyond.fill(Beyond{.what = What::alike});
  for (const Face face : plan.facades) {
    room.beyond[face] =
        Beyond{.what = What::outdoors, .room = {}, .window_share = drawings.window_share};
  }
  if (storey == 0) room.beyond[floor_face] = Beyond{.what = What::ground};
  if (storey + 1 == storeys) {
    const bool is_lit_from_above = plan.is_core || plan.name == "hall";
    room.beyond[ceiling] =
        Beyond{.what = What::outdoors,
               .room = {},
               .window_share = is_lit_from_above ? drawings.skylight_share : 0.0};
  }
  return room;
}

}  // namespace

std::string_view to_string(Shape shape) {
  switch (shape) {
    case Shape::deep:
      return "deep";
    case Shape::bar:
      return "bar";
    case Shape::hall:
      return "hall";
    case Shape::row:
      return "row";
    case Shape::court:
      return "court";
    case Shape::wings:
      break;
  }
  return "wings";
}

double RoomGroup::floor_m2() const {
  double sum_m2 = 0.0;
  for (const Room& room : rooms) sum_m2 += room.multiplier * room.floor_m2();
  return sum_m2;
}

std::vector<std::string> RoomGroup::room_names() const {
  std::vector<std::string> names;
  for (const Room& room : rooms) names.push_back(room.name);
  return names;
}

std::vector<RoomGroup> rooms_of(Shape shape, const Drawings& drawings) {
  constexpr double kHall_m = 7.0;
  const std::size_t storeys = is_low(shape) ? 1 : drawings.storeys_simulated();
  const double between = is_low(shape) ? 1.0 : drawings.storey_weight(1);
  RoomGroup house{shape == Shape::deep ? "Perimeter" : "House", {}};
  RoomGroup core_group{"Core", {}};
  for (std::size_t storey = 0; storey < storeys; ++storey) {
    for (const Plan& plan : plans_of(shape, drawings)) {
      const double height_m = plan.name == "hall" ? kHall_m : drawings.storey_height_m;
      Room room = room_at(plan, drawings, storey, storeys, height_m);
      if (storey == 1) room.multiplier = static_cast<int>(std::lround(between));
      (plan.is_core ? core_group : house).rooms.push_back(std::move(room));
    }
  }
  if (core_group.rooms.empty()) return {std::move(house)};
  return {std::move(house), std::move(core_group)};
}

}  // namespace recald::simulators::energyplus
