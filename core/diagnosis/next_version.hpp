/// What a diagnosis adds to the model, as the model's next version keeps it.
#pragma once

#include <string>

#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/model_version.hpp"

namespace recald::diagnosis {

/// Where a version comes from.
struct VersionOrigin {
  std::string data_revision;      ///< Of the readings that were diagnosed.
  std::string catalogue_version;  ///< Of the program whose effects were tried.
  std::string created_at;
};

/// The parent and what the diagnosis added.
[[nodiscard]] ModelVersion next_version(const Diagnosis& diagnosis, const SiteProblem& site,
                                        const ModelVersion& parent, const VersionOrigin& origin);

}  // namespace recald::diagnosis
