#include "daemon/site/model/version_list.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace recald::daemon {

std::vector<std::string> effect_ids(const diagnosis::ModelVersion& version) {
  std::vector<std::string> ids;
  for (const diagnosis::AddedEffect& added : version.effects) {
    ids.push_back(added.meter.empty() ? added.effect
                                      : fmt::format("{} ({})", added.effect, added.meter));
  }
  return ids;
}

nlohmann::ordered_json versions_json(const models::VersionList& list) {
  auto versions = nlohmann::ordered_json::array();
  for (const diagnosis::ModelVersion& version : list.versions) {
    versions.push_back({{"version", version.version},
                        {"parent", version.parent},
                        {"active", version.version == list.active},
                        {"status", name_of(version.status)},
                        {"author", name_of(version.author)},
                        {"created_at", version.created_at},
                        {"effects", effect_ids(version)}});
  }
  return {{"active", list.active}, {"versions", versions}, {"damaged", list.damaged}};
}

}  // namespace recald::daemon
