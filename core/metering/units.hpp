/// Converts the unit beside a value to the interval-mean power used everywhere else.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "core/metering/reading.hpp"
#include "core/result.hpp"

namespace recald::metering {

/// What a site must declare before a mass or a volume can become energy.
struct UnitFactors {
  /// Steam: energy per mass with condensate returned. The default is 0.305 kWh/lb, low-pressure
  /// saturated steam.
  double steam_kWh_per_kg = 0.305 / 0.45359237;
  /// Gas: energy per metered volume, as billed (gross calorific value times volume correction).
  std::optional<double> gas_kWh_per_m3;
};

/// How to read one unit: a rate is a mean over the interval, an amount is the interval's total.
struct UnitConversion {
  double factor;  ///< kW per unit of a rate, kWh per unit of an amount.
  bool is_rate;

  [[nodiscard]] double mean_kW(double value, std::chrono::seconds interval) const {
    return is_rate ? value * factor
                   : value * factor * 3600.0 / static_cast<double>(interval.count());
  }
};

/// Power: W kW MW GW, BTU/h kBtu/h MBtu/h MMBtu/h MBH, kWh/h, GJ/h, ton (of refrigeration), kg/h
/// lb/h m3/h. Energy: Wh kWh MWh GWh, J kJ MJ GJ, kcal Gcal, BTU kBtu MBtu MMBtu therm Dth,
/// ton-hour ton-day, kg t lb klb, m3 ft3 CCF MCF.
/// Ignored: case (except a leading m, which would be milli), plural s, blanks and hyphens, "hr" for
/// "h", and "m³" for "m3". MBtu is a million BTU as in Portfolio Manager, the same as MMBtu; MBH is
/// a thousand BTU per hour; CCF and MCF are a hundred and a thousand cubic feet. A ton is one of
/// refrigeration; t and tonne are a thousand kilograms.
///
/// @return the conversion for a meter of `utility`, or
///         invalid_value  the unit is not known, or a mass belongs to a meter other than steam;
///         unsupported    understood, but it takes more than a factor to make energy of it (l/s
///                        without a temperature difference, m3 without a heating value, water).
[[nodiscard]] Result<UnitConversion> find_unit(std::string_view unit, Utility utility,
                                               const UnitFactors& factors);

}  // namespace recald::metering
