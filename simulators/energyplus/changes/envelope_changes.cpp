#include <array>
#include <cmath>
#include <numbers>

#include "simulators/energyplus/changes/changes.hpp"

namespace recald::simulators::energyplus::changes {
namespace {

constexpr double kPer1000_m2 = 1e-3;

bool has_ground(const BuildingYear& building) {
  return has_object(building.model(), "Site:GroundTemperature:BuildingSurface");
}

bool has_simple_windows(const BuildingYear& building) {
  return has_object(building.model(), "WindowMaterial:SimpleGlazingSystem");
}

void ground_coupling(BuildingYear& building, double share, Rng /*rng*/) {
  constexpr double kSwing_K = 7.0;
  constexpr double kColdestMonth = 1.5;  // Counted from January as 0: late winter.
  constexpr std::array kMonths{"january",   "february", "march",    "april",
                               "may",       "june",     "july",     "august",
                               "september", "october",  "november", "december"};
  for_each_object(building.model(), "Site:GroundTemperature:BuildingSurface", [&](Json& ground) {
    for (std::size_t month = 0; month < kMonths.size(); ++month) {
      const double phase =
          2.0 * std::numbers::pi * (static_cast<double>(month) - kColdestMonth) / 12.0;
      Json& value = ground[std::string{kMonths[month]} + "_ground_temperature"];
      const double mean_C = value.is_number() ? value.get<double>() : 18.0;
      value = mean_C - share * kSwing_K * std::cos(phase);
    }
  });
  for_each_object(building.model(), "Material:NoMass", [&](const std::string& name, Json& layer) {
    if (name != "Ground insulation") return;
    layer["thermal_resistance"] = (1.0 - 0.9 * share) * layer["thermal_resistance"].get<double>();
  });
}

void solar_gain_change(BuildingYear& building, double share, Rng /*rng*/) {
  scale_solar_gain(building.model(), 1.0 + share);
}

/// Air through an opening, at 1 m³/s per 1000 m² of floor where the terms come to 1.
void add_leak(BuildingYear& building, const char* name, double m3_s_1000_m2, double per_kelvin,
              double per_squared_wind, const std::string& schedule) {
  const std::string zones = add_zone_list(building.model());
  building.model()["ZoneInfiltration:DesignFlowRate"][name] = {
      {"zone_or_zonelist_or_space_or_spacelist_name", zones},
      {"schedule_name", schedule},
      {"design_flow_rate_calculation_method", "Flow/Area"},
      {"flow_rate_per_floor_area", kPer1000_m2 * m3_s_1000_m2},
      {"constant_term_coefficient", 0.0},
      {"temperature_term_coefficient", per_kelvin},
      {"velocity_squared_term_coefficient", per_squared_wind}};
}

Quarters throughout(const BuildingYear& building, double value) {
  return Quarters(building.days().size() * kQuartersPerDay, value);
}

void stack_infiltration(BuildingYear& building, double m3_s_1000_m2, Rng /*rng*/) {
  constexpr double kAt_K = 20.0;
  // A stack draws in cold weather.
  Quarters cold = throughout(building, 0.0);
  constexpr double kMild_C = 16.0;
  for (std::size_t i = 0; i < cold.size(); ++i) {
    const double outdoors_C =
        building.weather_at(i / kQuartersPerDay, i % kQuartersPerDay).at_end.air.temperature_C;
    cold[i] = outdoors_C < kMild_C ? 1.0 : 0.0;
  }
  const std::string schedule = building.add_schedule("Stack draws", std::move(cold));
  add_leak(building, "Stairwell", m3_s_1000_m2, 1.0 / kAt_K, 0.0, schedule);
}

void wind_infiltration(BuildingYear& building, double m3_s_1000_m2, Rng /*rng*/) {
  constexpr double kAt_m_s = 4.0;
  const std::string schedule = building.add_schedule("Gaps", throughout(building, 1.0));
  add_leak(building, "Leaky facade", m3_s_1000_m2, 0.0, 1.0 / (kAt_m_s * kAt_m_s), schedule);
}

void thermal_mass(BuildingYear& building, double share, Rng /*rng*/) {
  scale(building.model(), "Material", {"density"}, 1.0 + share);
}

}  // namespace

void add_envelope_changes(std::vector<HiddenChange>& all) {
  all.insert(all.end(),
             {{"ground_coupling", 0.4, 1.0, "", has_ground, ground_coupling},
              {"solar_gain_change", -0.7, 0.7, "", has_simple_windows, solar_gain_change},
              {"stack_infiltration", 0.05, 1.0, "m3/s at 20 K for each 1000 m2 of floor", always,
               stack_infiltration},
              {"wind_infiltration", 0.05, 1.0, "m3/s at 4 m/s for each 1000 m2 of floor", always,
               wind_infiltration},
              {"thermal_mass", -0.75, 1.5, "", always, thermal_mass}});
}

}  // namespace recald::simulators::energyplus::changes
