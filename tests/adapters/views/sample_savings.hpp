/// Savings made up for the tests of their page.
#pragma once

#include "adapters/views/savings/savings_page.hpp"

namespace recald::views {

/// A measure that saves electricity and costs heat; its name tries to be markup.
[[nodiscard]] SavingsData sample_savings();

/// The same page with a month since a date, beside what was expected of it.
[[nodiscard]] SavingsData realised_savings();

}  // namespace recald::views
