/// Savings as the page shows them.
#pragma once

#include <string>

#include "adapters/views/savings/savings_page.hpp"
#include "daemon/site/savings/realised_savings.hpp"
#include "daemon/site/savings/site_savings.hpp"

namespace recald::daemon {

/// @param generated_at  As it shall stand on the page.
[[nodiscard]] views::SavingsData savings_report_of(const FinishedCalibration& finished,
                                                   const SiteSavings& savings,
                                                   std::string generated_at);
[[nodiscard]] views::SavingsData savings_report_of(const FinishedCalibration& finished,
                                                   const SavingsSince& savings,
                                                   std::string generated_at);

}  // namespace recald::daemon
