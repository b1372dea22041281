#include "adapters/energyplus/model/rooms.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "adapters/energyplus/model/fields.hpp"
#include "core/text/ascii.hpp"

namespace recald::energyplus {
namespace {

/// Half the length of the sum of cross products; a flat polygon in any position.
double polygon_area_m2(const Json& surface) {
  const auto vertices = surface.find("vertices");
  if (vertices == surface.end() || !vertices->is_array()) return 0.0;
  std::vector<Eigen::Vector3d> points;
  for (const Json& v : *vertices) {
    points.emplace_back(number_of(v, "vertex_x_coordinate"), number_of(v, "vertex_y_coordinate"),
                        number_of(v, "vertex_z_coordinate"));
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += points[i].cross(points[(i + 1) % points.size()]);
  }
  return 0.5 * sum.norm();
}

}  // namespace

/// One of the ways in which a type of object gives its amount.
struct Rooms::Way {
  std::string_view method;  ///< As the object's method has it.
  std::string_view field;
  enum class Per { room, area, person, area_reciprocal, unit } per;
};

Rooms::Rooms(const Json& objects) : objects_{objects} {
  for (const auto& [name, zone] : objects_of(objects, "Zone")) {
    multiplier_[to_lower(name)] = number_of(*zone, "multiplier", 1.0);
    area_m2_[to_lower(name)] = number_of(*zone, "floor_area");
  }
  for (const auto& [name, space] : objects_of(objects, "Space")) {
    const std::string zone = to_lower(text_of(*space, "zone_name"));
    multiplier_[to_lower(name)] = multiplier_.contains(zone) ? multiplier_.at(zone) : 1.0;
    area_m2_[to_lower(name)] = number_of(*space, "floor_area");
  }
  const std::map<std::string, double> given = area_m2_;
  const auto grow = [&](const std::string& room, double area) {
    if (given.contains(room) && given.at(room) == 0.0) area_m2_[room] += area;
  };
  for (const std::string_view type :
       {"BuildingSurface:Detailed", "Wall:Detailed", "RoofCeiling:Detailed", "Floor:Detailed"}) {
    for (const auto& [name, surface] : objects_of(objects, type)) {
      const double area = polygon_area_m2(*surface);
      const std::string zone = to_lower(text_of(*surface, "zone_name"));
      if (type == "Floor:Detailed" || to_lower(text_of(*surface, "surface_type")) == "floor") {
        grow(zone, area);
        grow(to_lower(text_of(*surface, "space_name")), area);
      }
      if (to_lower(text_of(*surface, "outside_boundary_condition")) == "outdoors") {
        exterior_m2_ += area * (multiplier_.contains(zone) ? multiplier_.at(zone) : 1.0);
      }
    }
  }
  for (const auto& [type, list, key] :
       {std::tuple{"ZoneList", "zones", "zone_name"}, {"SpaceList", "spaces", "space_name"}}) {
    for (const auto& [name, object] : objects_of(objects, type)) {
      const auto members = object->find(list);
      if (members == object->end() || !members->is_array()) continue;
      for (const Json& member : *members) {
        lists_[to_lower(name)].push_back(to_lower(text_of(member, key)));
      }
    }
  }
  for (const Level& level : people()) {
    const double rooms = count(level.rooms);
    for (const std::string& room : level.rooms) {
      if (rooms > 0.0) people_[room] += level.total / rooms;
    }
  }
}

std::vector<std::string> Rooms::rooms_of(std::string_view name) const {
  const std::string key = to_lower(name);
  const auto list = lists_.find(key);
  return list == lists_.end() ? std::vector{key} : list->second;
}

double Rooms::area_m2(const std::vector<std::string>& rooms) const {
  double sum = 0.0;
  for (const std::string& room : rooms) {
    if (area_m2_.contains(room)) sum += area_m2_.at(room) * multiplier_.at(room);
  }
  return sum;
}

double Rooms::count(const std::vector<std::string>& rooms) const {
  double sum = 0.0;
  for (const std::string& room : rooms) {
    sum += multiplier_.contains(room) ? multiplier_.at(room) : 1.0;
  }
  return sum;
}

double Rooms::people_in(const std::vector<std::string>& rooms) const {
  double sum = 0.0;
  for (const std::string& room : rooms) {
    if (people_.contains(room)) sum += people_.at(room) * count({room});
  }
  return sum;
}

std::vector<Level> Rooms::levels(std::string_view type, std::string_view method,
                                 std::string_view usual, const std::vector<Way>& ways) const {
  std::vector<Level> found;
  for (const auto& [name, object] : objects_of(objects_, type)) {
    const std::string chosen = text_of(*object, method, usual);
    const auto way = std::ranges::find_if(
        ways, [&](const Way& w) { return equals_ignoring_case(w.method, chosen); });
    if (way == ways.end()) continue;
    const auto value = object->find(std::string{way->field});
    if (value == object->end() || !value->is_number()) continue;
    Level level{Json::json_pointer{} / std::string{type} / name / std::string{way->field}};
    std::string where = text_of(*object, "zone_or_zonelist_or_space_or_spacelist_name");
    if (where.empty()) where = text_of(*object, "zone_or_space_name");
    level.rooms = rooms_of(where);
    const double amount = value->get<double>();
    switch (way->per) {
      case Way::Per::room:
        level.total = amount * count(level.rooms);
        break;
      case Way::Per::area:
        level.total = amount * area_m2(level.rooms);
        break;
      case Way::Per::person:
        level.total = amount * people_in(level.rooms);
        break;
      case Way::Per::area_reciprocal:
        level.sense = Sense::reciprocal;
        level.total = amount > 0.0 ? area_m2(level.rooms) / amount : 0.0;
        break;
      case Way::Per::unit:
        level.total = amount * number_of(*object, "number_of_units", 1.0) * count(level.rooms);
        break;
    }
    found.push_back(std::move(level));
  }
  return found;
}

std::vector<Level> Rooms::people() const {
  return levels("People", "number_of_people_calculation_method", "People",
                {{"People", "number_of_people", Way::Per::room},
                 {"People/Area", "people_per_floor_area", Way::Per::area},
                 {"Area/Person", "floor_area_per_person", Way::Per::area_reciprocal}});
}

std::vector<Level> Rooms::lights() const {
  return levels("Lights", "design_level_calculation_method", "LightingLevel",
                {{"LightingLevel", "lighting_level", Way::Per::room},
                 {"Watts/Area", "watts_per_floor_area", Way::Per::area},
                 {"Watts/Person", "watts_per_person", Way::Per::person}});
}

std::vector<Level> Rooms::equipment() const {
  auto found = levels("ElectricEquipment", "design_level_calculation_method", "EquipmentLevel",
                      {{"EquipmentLevel", "design_level", Way::Per::room},
                       {"Watts/Area", "watts_per_floor_area", Way::Per::area},
                       {"Watts/Person", "watts_per_person", Way::Per::person}});
  auto servers = levels("ElectricEquipment:ITE:AirCooled", "design_power_input_calculation_method",
                        "Watts/Unit",
                        {{"Watts/Unit", "watts_per_unit", Way::Per::unit},
                         {"Watts/Area", "watts_per_floor_area", Way::Per::area}});
  std::ranges::move(servers, std::back_inserter(found));
  return found;
}

double Rooms::density(const std::vector<Level>& levels) const {
  std::set<std::string> rooms;
  double total = 0.0;
  for (const Level& level : levels) {
    total += level.total;
    if (level.total > 0.0) rooms.insert(level.rooms.begin(), level.rooms.end());
  }
  const double area = area_m2({rooms.begin(), rooms.end()});
  return area > 0.0 ? total / area : 0.0;
}

double Rooms::outdoor_air_m3_s() const {
  const auto specifications = objects_of(objects_, "DesignSpecification:OutdoorAir");
  double sum = 0.0;
  for (const auto& [name, sizing] : objects_of(objects_, "Sizing:Zone")) {
    const std::string wanted = text_of(*sizing, "design_specification_outdoor_air_object_name");
    const auto found = std::ranges::find_if(
        specifications, [&](const auto& s) { return equals_ignoring_case(s.first, wanted); });
    if (wanted.empty() || found == specifications.end()) continue;
    const Json& air = *found->second;
    const auto rooms = rooms_of(text_of(*sizing, "zone_or_zonelist_name"));
    const std::string method = to_lower(text_of(air, "outdoor_air_method", "Flow/Person"));
    const double people = number_of(air, "outdoor_air_flow_per_person") * people_in(rooms);
    const double area = number_of(air, "outdoor_air_flow_per_zone_floor_area") * area_m2(rooms);
    const double zone = number_of(air, "outdoor_air_flow_per_zone") * count(rooms);
    // Air changes are left out: they need volumes, and are rare beside the other three.
    if (method == "flow/person") {
      sum += people;
    } else if (method == "flow/area") {
      sum += area;
    } else if (method == "flow/zone") {
      sum += zone;
    } else if (method == "maximum") {
      sum += std::max({people, area, zone});
    } else {
      sum += people + area + zone;
    }
  }
  return sum;
}

}  // namespace recald::energyplus
