#include <algorithm>

#include "simulators/energyplus/changes/changes.hpp"

namespace recald::simulators::energyplus::changes {
namespace {

bool has_lights(const BuildingYear& building) { return building.has(Role::lights); }

bool has_equipment(const BuildingYear& building) { return building.has(Role::equipment); }

/// The mean of what models give by floor; the usual where they do not.
double lamps_W_m2_of(const Json& model) {
  constexpr double kUsual_W_m2 = 9.0;
  double sum_W_m2 = 0.0;
  double count = 0.0;
  for_each_object(model, "Lights", [&](const Json& lamps) {
    const double of_floor_W_m2 = lamps.value("watts_per_floor_area", 0.0);
    if (of_floor_W_m2 <= 0.0) return;
    sum_W_m2 += of_floor_W_m2;
    count += 1.0;
  });
  return count > 0.0 ? sum_W_m2 / count : kUsual_W_m2;
}

/// By day at the strength, at night at a third of it.
void equipment_step(BuildingYear& building, double W_m2, Rng /*rng*/) {
  if (W_m2 < 0.0) {
    const double lamps_W_m2 = lamps_W_m2_of(building.model());
    scale_lights(building.model(), std::max(1.0 + W_m2 / lamps_W_m2, 0.2));
    return;
  }
  Quarters shares;
  for (std::size_t i = 0; i < building.days().size() * kQuartersPerDay; ++i) {
    const std::size_t quarter = i % kQuartersPerDay;
    const bool by_day =
        building.kind_of(i / kQuartersPerDay) == DayKind::workday && quarter >= 32 && quarter < 72;
    shares.push_back(by_day ? 1.0 : 1.0 / 3.0);
  }
  add_equipment(building, "New equipment", W_m2,
                building.add_schedule("New equipment on", std::move(shares)));
}

void exterior_lighting(BuildingYear& building, double W_m2, Rng /*rng*/) {
  const std::string always_on = building.add_schedule(
      "Lamps outside", Quarters(building.days().size() * kQuartersPerDay, 1.0));
  building.model()["Exterior:Lights"]["More lamps outside"] = {
      {"schedule_name", always_on},
      {"design_level", W_m2 * building.around().floor_m2},
      {"control_option", "AstronomicalClock"}};
}

void plug_growth(BuildingYear& building, double share, Rng /*rng*/) {
  scale_equipment(building.model(), 1.0 + share);
}

void server_room(BuildingYear& building, double W_m2, Rng /*rng*/) {
  add_equipment(
      building, "Servers", W_m2,
      building.add_schedule("Servers on", Quarters(building.days().size() * kQuartersPerDay, 1.0)));
}

}  // namespace

void add_electrical_changes(std::vector<HiddenChange>& all) {
  all.insert(all.end(),
             {{"equipment_step", -5.0, 8.0, "W/m2 of floor", has_lights, equipment_step,
               Course::at_once, kDated},
              {"exterior_lighting", 0.3, 5.0, "W/m2 of floor", always, exterior_lighting},
              {"plug_growth", -0.2, 0.4, "", has_equipment, plug_growth, Course::steadily},
              {"server_room", 0.3, 8.0, "W/m2 of floor", always, server_room}});
}

}  // namespace recald::simulators::energyplus::changes
