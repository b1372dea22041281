/// Published climate of the five cities that the generated climates resemble: used for comparison,
/// never as input of the generator.
#pragma once

#include <array>
#include <string_view>

#include "simulators/climate/climates.hpp"

namespace recald::simulators {

/// A city with a weather station of long record.
struct City {
  std::string_view name;
  Place place;                 ///< The station.
  std::string_view time_zone;  ///< IANA name.
};

using Monthly = std::array<double, 12>;

struct Normals {
  Monthly dry_bulb_C;
  Monthly daily_range_K;  ///< Mean daily maximum minus mean daily minimum.
  Monthly dew_point_C;
  Monthly wind_m_s;
  Monthly global_kWh_m2_day;
  Monthly precipitation_mm;
  double wet_days;          ///< Per year, with 0.25 mm or more.
  double snowfall_mm;       ///< Per year, as water; a tenth of the depth.
  double heating_K_days;    ///< Per year, below 18.3 degC.
  double cooling_K_days;    ///< Per year, above 18.3 degC.
  double heating_design_C;  ///< Exceeded in 99.6 % of hours.
  double cooling_design_C;  ///< Exceeded in 0.4 % of hours.
  double annual_minimum_C;  ///< Mean over years.
  double annual_maximum_C;  ///< Mean over years.
};

[[nodiscard]] const City& comparable_city(ClimateKind kind);
[[nodiscard]] const Normals& normals_of(ClimateKind kind);

/// Mean over the months, weighted by their length.
[[nodiscard]] double annual_mean(const Monthly& monthly);

}  // namespace recald::simulators
