#include "daemon/site/diagnose/proposed_version.hpp"

#include <algorithm>

#include "core/diagnosis/effects/support/effect.hpp"
#include "core/diagnosis/next_version.hpp"
#include "daemon/site/model/version_list.hpp"

namespace recald::daemon {

Result<diagnosis::ModelVersion> propose_version(const models::ModelStore& store,
                                                const ModelledSite& modelled,
                                                const diagnosis::Diagnosis& diagnosis,
                                                const diagnosis::SiteProblem& problem,
                                                const std::string& at,
                                                diagnosis::VersionAuthor author) {
  const auto parent = TRY(store.load(diagnosis::kBaseVersion));
  return store.save(diagnosis::next_version(diagnosis, problem, parent,
                                            {.data_revision = modelled.facts.data_revision,
                                             .catalogue_version = modelled.facts.recald_version,
                                             .created_at = at,
                                             .author = author}));
}

bool may_apply_itself(const diagnosis::ModelVersion& version, const models::VersionList& known) {
  constexpr double kSure = 0.95;
  const bool was_taken_back =
      std::ranges::any_of(known.versions, [&](const diagnosis::ModelVersion& other) {
        return other.status == diagnosis::VersionStatus::reverted &&
               effect_ids(other) == effect_ids(version);
      });
  return !version.effects.empty() && !was_taken_back && known.active == diagnosis::kBaseVersion &&
         std::ranges::all_of(version.effects, [&](const diagnosis::AddedEffect& added) {
           const diagnosis::Effect* const effect = diagnosis::find_effect(added.effect);
           return added.probability >= kSure && effect != nullptr &&
                  (effect->effect_class == diagnosis::EffectClass::meter ||
                   effect->effect_class == diagnosis::EffectClass::schedule);
         });
}

}  // namespace recald::daemon
