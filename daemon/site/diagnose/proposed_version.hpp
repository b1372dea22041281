/// What a diagnosis found, as a version of the model that is not in force yet.
#pragma once

#include <string>

#include "adapters/models/model_store.hpp"
#include "core/diagnosis/diagnose.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Stores the drawings, from which a diagnosis starts, with the additions.
/// @param at  ISO 8601. @return the stored version, or as `models::ModelStore::save`.
[[nodiscard]] Result<diagnosis::ModelVersion> propose_version(const models::ModelStore& store,
                                                              const ModelledSite& modelled,
                                                              const diagnosis::Diagnosis& diagnosis,
                                                              const diagnosis::SiteProblem& problem,
                                                              const std::string& at,
                                                              diagnosis::VersionAuthor author);

/// Whether nobody has to look at a version before it is put in force: all of its effects are faults
/// of meters or schedules with at least 95 %, the drawings are in force, and nobody has taken back
/// the same effects before.
/// @param known  All versions of the model.
[[nodiscard]] bool may_apply_itself(const diagnosis::ModelVersion& version,
                                    const models::VersionList& known);

}  // namespace recald::daemon
