/// Savings in words, and as the page shows them.
#pragma once

#include <string>

#include "adapters/report/savings_page.hpp"
#include "daemon/site/savings/realised_savings.hpp"
#include "daemon/site/savings/site_savings.hpp"

namespace recald::daemon {

/// @param generated_at  As it shall stand on the page.
[[nodiscard]] report::SavingsData savings_report_of(const FinishedCalibration& finished,
                                                    const SiteSavings& savings,
                                                    std::string generated_at);
[[nodiscard]] report::SavingsData savings_report_of(const FinishedCalibration& finished,
                                                    const SavingsSince& savings,
                                                    std::string generated_at);

/// The same for a terminal: a table a card, then what the numbers do not know.
[[nodiscard]] std::string savings_words(const report::SavingsData& data);

}  // namespace recald::daemon
