/// The files of a diagnosis.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"
#include "daemon/site/diagnose/site_diagnosis.hpp"

namespace recald::daemon {

/// diagnosis.html, then diagnosis.json, which says that all is there. The report.html of a
/// calibration of the same data gets what is most likely. @param at  Shown on the page.
[[nodiscard]] Result<void> write_diagnosis(const SiteDiagnosis& done, const ModelledSite& modelled,
                                           const diagnosis::SiteProblem& problem,
                                           const std::string& json, const std::string& at,
                                           const std::filesystem::path& folder);

/// What a diagnosis of these data in the folder holds most likely; empty: there is none.
[[nodiscard]] std::string most_likely_in(const std::filesystem::path& folder,
                                         const std::string& data_revision);

}  // namespace recald::daemon
