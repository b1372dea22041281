/// What a diagnosis found, as a version of the model that is not in force yet.
#pragma once

#include <string>

#include "adapters/models/model_store.hpp"
#include "core/diagnosis/diagnose.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Stores the version in force with the additions.
/// @param at  ISO 8601. @return the stored version, or as `models::ModelStore::save`.
[[nodiscard]] Result<diagnosis::ModelVersion> propose_version(const models::ModelStore& store,
                                                              const ModelledSite& modelled,
                                                              const diagnosis::Diagnosis& diagnosis,
                                                              const diagnosis::SiteProblem& problem,
                                                              const std::string& at);

/// Whether nobody has to look at a version before it is put in force: all that it adds is a fault
/// of a meter or of a schedule, each with at least 95 %.
[[nodiscard]] bool may_apply_itself(const diagnosis::ModelVersion& version);

}  // namespace recald::daemon
