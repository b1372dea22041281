#include "daemon/site/model/active_effects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/models/model_store.hpp"

namespace recald::daemon {

using diagnosis::AddedEffect;
using diagnosis::EffectParameterRecord;

Result<diagnosis::ModelVersion> active_version(const SiteConfig& site) {
  return models::ModelStore{site.versions_beside(), site.id}.active();
}

std::string version_name(const diagnosis::ModelVersion& active, const std::string& drawings) {
  return active.effects.empty() ? drawings : active.version;
}

Result<std::vector<AddedEffect>> active_effects(const SiteConfig& site) {
  auto version = TRY(active_version(site));
  return std::move(version.effects);
}

Result<void> require_in_design(std::span<const AddedEffect> effects,
                               std::span<const Parameter> design) {
  for (const AddedEffect& effect : effects) {
    for (const EffectParameterRecord& parameter : effect.parameters) {
      const std::string name = effect_parameter_name(effect, parameter);
      if (std::ranges::find(design, name, &Parameter::name) != design.end()) continue;
      return failure(ErrorCode::unsupported,
                     fmt::format("metamodel: effect {} is not in the design; run `recald doe` with "
                                 "it.",
                                 effect.effect));
    }
  }
  return {};
}

}  // namespace recald::daemon
