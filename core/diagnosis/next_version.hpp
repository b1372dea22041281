/// Turns the result of a diagnosis into the model's next version.
#pragma once

#include <string>

#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/model_version.hpp"

namespace recald::diagnosis {

/// The origin of a version.
struct VersionOrigin {
  std::string data_revision;      ///< Of the diagnosed readings.
  std::string catalogue_version;  ///< Of the program whose effects were tried.
  std::string created_at;
  VersionAuthor author = VersionAuthor::human;
};

/// The parent plus the additions of the diagnosis.
[[nodiscard]] ModelVersion next_version(const Diagnosis& diagnosis, const SiteProblem& site,
                                        const ModelVersion& parent, const VersionOrigin& origin);

}  // namespace recald::diagnosis
