/// What the outdoor temperature adds to a day's consumption.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace recald::change_point {

/// The change-point forms of the inverse modelling toolkit, by their number of parameters.
/// @see Kissock, Haberl, Claridge (2003), ASHRAE Trans. 109(2), figures 2 to 4.
enum class Form : std::size_t {
  no_temperature,
  heating_3p,
  cooling_3p,
  two_slopes_4p,
  two_slopes_5p
};
inline constexpr std::size_t kForms = 5;
inline constexpr std::array<const char*, kForms> kFormNames = {
    "no temperature", "3-parameter heating", "3-parameter cooling", "4-parameter", "5-parameter"};

/// h max(0, T_h - T) + c max(0, T - T_c), in kWh a day.
///
/// Both slopes are >= 0 in the forms with three and five parameters. The form with four has one
/// balance temperature and may have one negative slope: then consumption falls (or rises) with the
/// temperature on both sides of it, steeper on one. What falls on both sides away from a balance
/// temperature has no thermal meaning and is not fitted.
struct Curve {
  Form form = Form::no_temperature;
  double heating_slope_kWh_K = 0.0;  ///< h, a day and kelvin below T_h.
  double heating_balance_C = std::numeric_limits<double>::quiet_NaN();  ///< T_h
  double cooling_slope_kWh_K = 0.0;  ///< c, a day and kelvin above T_c.
  double cooling_balance_C = std::numeric_limits<double>::quiet_NaN();  ///< T_c >= T_h

  /// kWh a day. An absent balance temperature compares false, and its side adds nothing.
  [[nodiscard]] double at(double dry_bulb_C) const {
    double added = 0.0;
    if (dry_bulb_C < heating_balance_C) {
      added += heating_slope_kWh_K * (heating_balance_C - dry_bulb_C);
    }
    if (dry_bulb_C > cooling_balance_C) {
      added += cooling_slope_kWh_K * (dry_bulb_C - cooling_balance_C);
    }
    return added;
  }
};

}  // namespace recald::change_point
