/// Numbers inside sentences for people.
#pragma once

#include <string>

namespace recald {

/// `digits` significant digits, never a decimal comma whatever the locale: "0.1534", "1.2e+06".
[[nodiscard]] std::string number_text(double value, int digits = 4);

/// A share of one as per cent with one decimal: "15.3 %".
[[nodiscard]] std::string percent_text(double share);

/// A share as per cent with its sign, whole unless it is less than one: "+31 %", "-0.4 %".
[[nodiscard]] std::string signed_percent_text(double share);

}  // namespace recald
