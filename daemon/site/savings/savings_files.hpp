/// Savings as files: ecm.json, savings.csv and the page savings.html.
#pragma once

#include <filesystem>
#include <string>

#include "daemon/site/model/run_facts.hpp"
#include "daemon/site/savings/realised_savings.hpp"
#include "daemon/site/savings/site_savings.hpp"

namespace recald::daemon {

[[nodiscard]] std::string savings_json(const FinishedCalibration& finished,
                                       const SiteSavings& savings);
[[nodiscard]] std::string savings_json(const FinishedCalibration& finished,
                                       const SavingsSince& savings);

/// Writes the three files into a folder that may not be there yet.
/// @param generated_at  As it shall stand on the page.
/// @param json          Of `savings_json`.
/// @return or what could not be written.
[[nodiscard]] Result<void> write_savings(const FinishedCalibration& finished,
                                         const SiteSavings& savings, std::string generated_at,
                                         const std::string& json,
                                         const std::filesystem::path& folder);
[[nodiscard]] Result<void> write_savings(const FinishedCalibration& finished,
                                         const SavingsSince& savings, std::string generated_at,
                                         const std::string& json,
                                         const std::filesystem::path& folder);

}  // namespace recald::daemon
