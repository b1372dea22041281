/// What something costs a year, in words.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace recald::views {

/// "It costs about 1,240 USD and 2.1 t of CO2 a year.", "It saves …"; empty where nothing is known.
///
/// @param money_month         Of the mean month, in `currency`; absent: no price is known.
/// @param emissions_kg_month  CO2 of the mean month, likewise. Less than 1 is not mentioned.
[[nodiscard]] std::string cost_words(std::optional<double> money_month,
                                     std::optional<double> emissions_kg_month,
                                     const std::string& currency);

/// The same of amounts over whatever `period` says: "It costs about 540 USD so far."
[[nodiscard]] std::string cost_words(std::optional<double> money,
                                     std::optional<double> emissions_kg,
                                     const std::string& currency, std::string_view period);

}  // namespace recald::views
