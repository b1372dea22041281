/// The files of a diagnosis.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"
#include "daemon/site/diagnose/site_diagnosis.hpp"

namespace recald::daemon {

/// diagnosis.html, then diagnosis.json, which says that all is there. @param at  Shown on the page.
[[nodiscard]] Result<void> write_diagnosis(const SiteDiagnosis& done, const ModelledSite& modelled,
                                           const diagnosis::SiteProblem& problem,
                                           const std::string& json, const std::string& at,
                                           const std::filesystem::path& folder);

}  // namespace recald::daemon
