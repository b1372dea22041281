#include "simulators/energyplus/changes/hidden_change.hpp"

#include <algorithm>

#include "simulators/energyplus/changes/changes.hpp"

namespace recald::simulators::energyplus {

const std::vector<HiddenChange>& hidden_changes() {
  static const std::vector<HiddenChange> all = [] {
    std::vector<HiddenChange> list;
    changes::add_schedule_changes(list);
    changes::add_air_changes(list);
    changes::add_envelope_changes(list);
    changes::add_plant_changes(list);
    changes::add_electrical_changes(list);
    changes::add_changes_outside_the_catalogue(list);
    std::ranges::sort(list, {}, &HiddenChange::id);
    return list;
  }();
  return all;
}

const HiddenChange* hidden_change(std::string_view id) {
  const auto& all = hidden_changes();
  const auto found = std::ranges::find(all, id, &HiddenChange::id);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace recald::simulators::energyplus
