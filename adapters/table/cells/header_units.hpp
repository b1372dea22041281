/// Units where exports have them: in headers, above the table, behind numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace recald::table {

/// "Main (kWh)", "Main [kWh]", "Main kWh", "Main_kWh", "Main.kWh", "Energy in kilowatt-hours",
/// "kWh delivered" as name and unit. No unit is taken from a price or a rate of something for each
/// kWh ("ct/kWh", "price per kWh"), nor with a factor beside it ("100 kWh").
struct NameAndUnit {
  std::string name;
  std::string unit;  ///< May be empty.
  bool is_unit_in_brackets = false;
};
[[nodiscard]] NameAndUnit split_unit(std::string_view header);

/// Whether a text is a possible unit of a meter.
[[nodiscard]] bool is_unit(std::string_view text);

/// Whether a text is the unit of another quantity: kvarh, V, °C, EUR, kgCO2.
[[nodiscard]] bool is_unit_of_others(std::string_view text);

/// The unit that a row above the table says all values have: "Einheit: kWh", "Unité;W" (beside it),
/// "Messwerte in kW". Empty: none.
[[nodiscard]] std::string unit_said(const std::vector<std::string>& cells);

/// Whether a text is a header of units: "Einheit", "Unité", "UoM".
[[nodiscard]] bool is_word_for_unit(std::string_view text);

}  // namespace recald::table
