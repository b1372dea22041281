/// Texts of ours that have temperatures in them.
#pragma once

#include <string>

#include "core/display/unit.hpp"

namespace recald::display {

/// The text with its temperatures in the unit of display, whole degrees in IP: "between 8 and 18
/// °C" → "between 46 and 64 °F". In SI as it is.
[[nodiscard]] std::string with_temperatures_in(UnitSystem system, const std::string& text);

}  // namespace recald::display
