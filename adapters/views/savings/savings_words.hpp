/// Savings in words, for a terminal.
#pragma once

#include <string>

#include "adapters/views/savings/savings_page.hpp"

namespace recald::views {

/// A table a card, then what the numbers do not know.
[[nodiscard]] std::string savings_words(const SavingsData& data);

}  // namespace recald::views
