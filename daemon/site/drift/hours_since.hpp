/// What the hours of a site say of a change: which effects may have begun on its day.
#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/model_version.hpp"
#include "core/drift/named_change.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// @param modelled  Outlives what is made.
/// @param months    "2019-03", ascending: an alarm's months are places among them.
/// @param meters    (outputs) Ids of the meters that the alarms' outputs are figures of.
/// @param added     Of the model version in force.
/// @return nothing for a site without a [building].
[[nodiscard]] drift::AskHours ask_hours_of(const ModelledSite& modelled,
                                           std::vector<std::string> months,
                                           std::vector<std::string> meters,
                                           std::vector<diagnosis::AddedEffect> added);

}  // namespace recald::daemon
