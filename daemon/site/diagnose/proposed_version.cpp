#include "daemon/site/diagnose/proposed_version.hpp"

#include <algorithm>

#include "core/diagnosis/effect.hpp"
#include "core/diagnosis/next_version.hpp"

namespace recald::daemon {

Result<diagnosis::ModelVersion> propose_version(const models::ModelStore& store,
                                                const ModelledSite& modelled,
                                                const diagnosis::Diagnosis& diagnosis,
                                                const diagnosis::SiteProblem& problem,
                                                const std::string& at) {
  const auto parent = store.active();
  if (!parent) return tl::unexpected(parent.error());
  return store.save(diagnosis::next_version(diagnosis, problem, *parent,
                                            {.data_revision = modelled.facts.data_revision,
                                             .catalogue_version = modelled.facts.recald_version,
                                             .created_at = at}));
}

bool may_apply_itself(const diagnosis::ModelVersion& version) {
  constexpr double kSure = 0.95;
  return !version.effects.empty() &&
         std::ranges::all_of(version.effects, [&](const diagnosis::AddedEffect& added) {
           const diagnosis::Effect* const effect = diagnosis::find_effect(added.effect);
           return added.probability >= kSure && effect != nullptr &&
                  (effect->effect_class == diagnosis::EffectClass::meter ||
                   effect->effect_class == diagnosis::EffectClass::schedule);
         });
}

}  // namespace recald::daemon
