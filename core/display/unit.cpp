#include "core/display/unit.hpp"

#include <algorithm>
#include <array>

namespace recald::display {
namespace {

using metering::Utility;

constexpr double kBtu_kWh = 1055.05585262 / 3.6e6;
constexpr double kTon_kW = 12'000.0 * kBtu_kWh;
constexpr double kFoot_m = 0.3048;
constexpr double kFoot2_m2 = kFoot_m * kFoot_m;
constexpr double kFahrenheit_K = 1.8;

/// A unit by its name in files, then as it is shown in either system.
struct KnownUnit {
  std::string_view file;
  std::string_view si;
  std::string_view ip;
  double factor;
  double offset = 0.0;
};

constexpr auto kUnits = std::to_array<KnownUnit>({
    {"-", "", "", 1.0},
    {"degC", "°C", "°F", kFahrenheit_K, 32.0},
    {"C", "°C", "°F", kFahrenheit_K, 32.0},
    {"K", "K", "°F", kFahrenheit_K},
    {"1/K", "1/K", "1/°F", 1.0 / kFahrenheit_K},
    {"h/K", "h/K", "h/°F", 1.0 / kFahrenheit_K},
    {"K/K", "K/K", "°F/°F", 1.0},
    {"m/s", "m/s", "mph", 3600.0 / (5280.0 * kFoot_m)},
    {"m2", "m²", "ft²", 1.0 / kFoot2_m2},
    {"m3/s", "m³/s", "cfm", 60.0 / (kFoot2_m2 * kFoot_m)},
    {"m3/day", "m³/day", "gal/day", 1e3 / 3.785411784},
    {"person/m2", "persons/m²", "persons/1,000 ft²", 1e3 * kFoot2_m2},
    {"persons/m2", "persons/m²", "persons/1,000 ft²", 1e3 * kFoot2_m2},
    {"W/m2", "W/m²", "W/ft²", kFoot2_m2},
    {"W/m2K", "W/(m²·K)", "Btu/(h·ft²·°F)", kFoot2_m2 / (1e3 * kBtu_kWh * kFahrenheit_K)},
    {"J/m2K", "J/(m²·K)", "Btu/(ft²·°F)", kFoot2_m2 / (3.6e6 * kBtu_kWh * kFahrenheit_K)},
    {"kJ/m2K", "kJ/(m²·K)", "Btu/(ft²·°F)", kFoot2_m2 / (3.6e3 * kBtu_kWh * kFahrenheit_K)},
    {"cm2/m2", "cm²/m²", "in²/100 ft²", 100.0 * kFoot2_m2 / (2.54 * 2.54)},
});

struct EnergyUnits {
  std::string_view energy;
  double per_kWh;
  std::string_view power;
  double per_kW;
};

EnergyUnits ip_units(Utility utility) {
  switch (utility) {
    case Utility::chilled_water:
      return {"ton-hours", 1.0 / kTon_kW, "tons", 1.0 / kTon_kW};
    case Utility::heating:
    case Utility::steam:
      return {"MMBtu", 1e-6 / kBtu_kWh, "MBH", 1e-3 / kBtu_kWh};
    case Utility::gas:
      return {"therms", 1e-5 / kBtu_kWh, "MBH", 1e-3 / kBtu_kWh};
    case Utility::electricity:
    case Utility::water:
      break;
  }
  return {"kWh", 1.0, "kW", 1.0};
}

/// "kWh/day per K", the energy's name and factor put in.
Unit energy_unit(std::string_view name, double factor, std::string_view per, bool is_ip) {
  constexpr std::string_view kPerKelvin = " per K";
  Unit unit{std::string{name} + std::string{per}, factor};
  if (is_ip && per.ends_with(kPerKelvin)) {
    unit.name.replace(unit.name.size() - 1, 1, "°F");
    unit.factor /= kFahrenheit_K;
  }
  return unit;
}

}  // namespace

Unit unit_of(UnitSystem system, std::string_view si_unit, Utility utility) {
  const bool is_ip = system == UnitSystem::ip;
  const EnergyUnits ip = ip_units(utility);
  const auto after = [&](std::string_view start) { return si_unit.substr(start.size()); };
  if (si_unit.starts_with("kWh")) {
    return is_ip ? energy_unit(ip.energy, ip.per_kWh, after("kWh"), is_ip)
                 : energy_unit("kWh", 1.0, after("kWh"), is_ip);
  }
  if (si_unit.starts_with("MWh")) {
    // Bills are in kWh; there is no larger unit of the others in use.
    return is_ip ? energy_unit(ip.energy, 1e3 * ip.per_kWh, after("MWh"), is_ip)
                 : energy_unit("MWh", 1.0, after("MWh"), is_ip);
  }
  if (si_unit == "kW" && is_ip) return {std::string{ip.power}, ip.per_kW};
  const auto* const known = std::ranges::find(kUnits, si_unit, &KnownUnit::file);
  if (known == kUnits.end()) return {std::string{si_unit}};
  return is_ip ? Unit{std::string{known->ip}, known->factor, known->offset}
               : Unit{std::string{known->si}};
}

MeterUnits meter_units(UnitSystem system, Utility utility) {
  const auto unit = [&](std::string_view si_unit) { return unit_of(system, si_unit, utility); };
  return {.power = unit("kW"),
          .energy = unit("kWh"),
          .large_energy = unit("MWh"),
          .daily = unit("kWh/day"),
          .daily_per_degree = unit("kWh/day per K")};
}

}  // namespace recald::display
