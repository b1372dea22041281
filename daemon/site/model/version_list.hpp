/// The versions of a site's model, for people and programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "adapters/models/model_store.hpp"

namespace recald::daemon {

/// "weekend_operation", "scale_fault (main)", in the order of addition.
[[nodiscard]] std::vector<std::string> effect_ids(const diagnosis::ModelVersion& version);

/// {"active", "versions": [...], "damaged": [...]}
[[nodiscard]] nlohmann::ordered_json versions_json(const models::VersionList& list);

}  // namespace recald::daemon
