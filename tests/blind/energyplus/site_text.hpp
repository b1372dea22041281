/// The site file of an EnergyPlus building, as an engineer with its drawings would write it.
#pragma once

#include <cstdint>
#include <string>

#include "simulators/building/drawings.hpp"
#include "simulators/energyplus/building_year.hpp"
#include "simulators/feed/meters.hpp"
#include "tests/blind/energyplus/engine.hpp"
#include "tests/blind/population/base_parameters.hpp"

namespace recald::blind {

/// A meter of the case. @see `simulators::MeterPlate` for its unit and noise.
struct CaseMeter {
  simulators::Utility utility;
  MeterSum sum;
};

/// The meters that the model's plant calls for: electricity; cooling where water is chilled; heat
/// from the district or gas. A chiller's own electricity is in electricity.
[[nodiscard]] std::vector<CaseMeter> meters_of(const Json& model);

/// What the drawings say of the parameters that every model calibrates.
[[nodiscard]] BaseParameters as_drawn(const SizedModel& sized,
                                      const simulators::energyplus::BuildingYear& drawings);

/// What no table of EnergyPlus tells.
struct SiteFacts {
  std::string id;
  std::string title;  ///< Of what is built: "office, two wings, fan coils".
  std::string time_zone;
  simulators::Place place;
  int first_year;
  int years;
  std::vector<metering::Day> holidays;  ///< Of all years.
  double leakage_cm2_m2;
  bool heavy;
};

/// @param drawings  A year of the building by its drawings, sized.
/// @param meters    With what they are rated at, kW.
/// @param rng       What the engineer misremembers: constructions, densities, nameplates.
[[nodiscard]] std::string site_text(const SiteFacts& facts, const SizedModel& sized,
                                    const simulators::energyplus::BuildingYear& drawings,
                                    const std::vector<simulators::MeterPlate>& plates, Rng rng);

}  // namespace recald::blind
