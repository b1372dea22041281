/// The hidden changes by what they touch.
#pragma once

#include "simulators/energyplus/changes/hidden_change.hpp"
#include "simulators/energyplus/model_edits.hpp"

namespace recald::simulators::energyplus::changes {

[[nodiscard]] inline bool always(const BuildingYear& /*building*/) { return true; }
[[nodiscard]] inline bool has_people(const BuildingYear& building) {
  return building.has(Role::presence);
}

void add_schedule_changes(std::vector<HiddenChange>& all);
void add_air_changes(std::vector<HiddenChange>& all);
void add_envelope_changes(std::vector<HiddenChange>& all);
void add_plant_changes(std::vector<HiddenChange>& all);
void add_electrical_changes(std::vector<HiddenChange>& all);
void add_changes_outside_the_catalogue(std::vector<HiddenChange>& all);

}  // namespace recald::simulators::energyplus::changes
