/// The units in which pages and the console speak. Everything is computed and filed in SI.
#pragma once

#include <string>
#include <string_view>

#include "core/metering/reading.hpp"

namespace recald::display {

enum class UnitSystem : unsigned char {
  si,  ///< kWh, kW, °C, m²
  ip,  ///< As American practice has it: ton-hours, MMBtu, therms, tons, MBH, °F, ft².
};

/// How a quantity is shown: its value in SI times `factor` plus `offset`.
struct Unit {
  std::string name;  ///< As it stands behind a number: "ton-hours/day"; empty: a bare number.
  double factor = 1.0;
  double offset = 0.0;  ///< Of temperatures; 0 otherwise.

  [[nodiscard]] double shown(double si) const { return si * factor + offset; }
  /// A spread or a change: without the offset.
  [[nodiscard]] double shown_difference(double si) const { return si * factor; }
};

/// The unit of display of a quantity that we hold in `si_unit`.
///
/// @param si_unit  As our files write it: "kWh", "MWh", "kWh/day", "kWh/day per K", "kW", "degC",
///                 "K", "m2", "m3/s", … A unit that is not known is shown as it is, in both
///                 systems.
/// @param utility  Of energy and power. In IP, electricity stays in kWh and kW; chilled water is in
///                 ton-hours and tons; steam and heating in MMBtu and MBH; gas in therms and MBH.
[[nodiscard]] Unit unit_of(UnitSystem system, std::string_view si_unit,
                           metering::Utility utility = metering::Utility::electricity);

/// The units in which a meter's numbers are shown; SI where nothing is said.
struct MeterUnits {
  Unit power{"kW"};
  Unit energy{"kWh"};
  Unit large_energy{"MWh"};  ///< Of years; values are in MWh.
  Unit daily{"kWh/day"};
  Unit daily_per_degree{"kWh/day per K"};
};

[[nodiscard]] MeterUnits meter_units(UnitSystem system, metering::Utility utility);

}  // namespace recald::display
