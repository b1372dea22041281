/// Numbers, shares and months as the report prints them: the same in every locale.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "core/display/unit.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::views {

/// Four significant digits, thousands separated: 12345.6 → "12,346"; 0.01234 → "0.01234".
/// NaN and infinity → "–".
[[nodiscard]] std::string number_text(double value);
[[nodiscard]] std::string number_text(std::optional<double> value);

/// A number in SI with its unit of display: 352.0 kW → "100.1 tons", with a no-break space. NaN →
/// "–".
[[nodiscard]] std::string amount_text(double si, const display::Unit& unit);

/// The same of a change, with its sign and at most three digits behind the point: "+4,200 kWh".
[[nodiscard]] std::string signed_amount_text(double si, const display::Unit& unit);

/// A whole number, thousands separated: 4776 → "4,776". NaN → "–".
[[nodiscard]] std::string count_text(double count);

/// A share in percent: 0.1534 → "15.3 %", with a no-break space.
[[nodiscard]] std::string percent_text(double share, int decimals = 1);

/// "Steam, kWh/day"; the label alone where the unit is empty.
[[nodiscard]] std::string with_unit(const std::string& label, const std::string& unit);

/// A probability: 0.1534 → "15.3 %"; the ends, which no data reach, are "over 99.9 %" and
/// "under 0.1 %".
[[nodiscard]] std::string probability_text(double probability);

/// A signed share in percent, with a true minus sign: −0.021 → "−2.1 %", 0.02 → "+2.0 %".
[[nodiscard]] std::string signed_percent_text(double share);

[[nodiscard]] std::string month_text(metering::Month month);  ///< "Mar 2021"
[[nodiscard]] std::string month_key(metering::Month month);   ///< "2021-03"
/// The same of a month that may have no calendar: "Month 7" and "7". @param number  "7", or empty.
[[nodiscard]] std::string month_text(metering::Month month, const std::string& number);
[[nodiscard]] std::string month_key(metering::Month month, const std::string& number);
[[nodiscard]] std::string day_key(metering::Day day);  ///< "2021-03-09"
[[nodiscard]] std::string month_name(unsigned month);  ///< 1 → "Jan"

/// "2021-03-09 15:45" in the calendar's local time, or in UTC without one.
[[nodiscard]] std::string local_text(metering::Instant t,
                                     const std::optional<metering::LocalCalendar>& calendar);

/// A four-hour part of the week, 0 being Sunday 00–04 h: 8 → "Mon 08–12 h". @pre 0 <= part < 42
[[nodiscard]] std::string part_of_week_text(int part);
[[nodiscard]] std::string part_of_day_text(int part);  ///< 2 → "08–12 h". @pre 0 <= part < 6

/// The meaning of a parameter's contraction, as a sentence.
[[nodiscard]] std::string contraction_sentence(double contraction);

}  // namespace recald::views
