#include "core/metering/units.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace recald::metering {
namespace {

// International Table BTU: 1055.05585262 J.
constexpr double kBtu_kWh = 1055.05585262 / 3.6e6;
constexpr double kTon_kW = 12'000.0 * kBtu_kWh;  // ton of refrigeration, 3.516853 kW
constexpr double kPound_kg = 0.45359237;

enum class Measures { energy, mass, gas_volume };

struct KnownUnit {
  std::string_view spelling;  // lower case
  double factor;              // kW or kWh; kg(/h); m3(/h)
  bool is_rate;
  Measures measures = Measures::energy;
};

constexpr std::array kUnits{
    KnownUnit{"w", 1e-3, true},
    KnownUnit{"kw", 1.0, true},
    KnownUnit{"mw", 1e3, true},
    KnownUnit{"gw", 1e6, true},
    KnownUnit{"btu/h", kBtu_kWh, true},
    KnownUnit{"btu/hr", kBtu_kWh, true},
    KnownUnit{"kbtu/h", 1e3 * kBtu_kWh, true},
    KnownUnit{"kbtu/hr", 1e3 * kBtu_kWh, true},
    KnownUnit{"mbh", 1e3 * kBtu_kWh, true},
    KnownUnit{"mbtu/h", 1e6 * kBtu_kWh, true},
    KnownUnit{"mmbtu/h", 1e6 * kBtu_kWh, true},
    KnownUnit{"ton", kTon_kW, true},
    KnownUnit{"tons", kTon_kW, true},
    KnownUnit{"wh", 1e-3, false},
    KnownUnit{"kwh", 1.0, false},
    KnownUnit{"mwh", 1e3, false},
    KnownUnit{"gwh", 1e6, false},
    KnownUnit{"j", 1.0 / 3.6e6, false},
    KnownUnit{"kj", 1.0 / 3.6e3, false},
    KnownUnit{"mj", 1.0 / 3.6, false},
    KnownUnit{"gj", 1.0 / 3.6e-3, false},
    KnownUnit{"btu", kBtu_kWh, false},
    KnownUnit{"kbtu", 1e3 * kBtu_kWh, false},
    KnownUnit{"mbtu", 1e6 * kBtu_kWh, false},
    KnownUnit{"mmbtu", 1e6 * kBtu_kWh, false},
    KnownUnit{"therm", 1e5 * kBtu_kWh, false},
    KnownUnit{"ton-hour", kTon_kW, false},
    KnownUnit{"ton-h", kTon_kW, false},
    KnownUnit{"ton-hr", kTon_kW, false},
    KnownUnit{"kg", 1.0, false, Measures::mass},
    KnownUnit{"kg/h", 1.0, true, Measures::mass},
    KnownUnit{"lb", kPound_kg, false, Measures::mass},
    KnownUnit{"lb/h", kPound_kg, true, Measures::mass},
    KnownUnit{"m3", 1.0, false, Measures::gas_volume},
    KnownUnit{"m3/h", 1.0, true, Measures::gas_volume},
};

constexpr std::array<std::string_view, 6> kFlows{"l/s", "l/h", "l/min", "gpm", "m3/s", "gal"};

std::string lower(std::string_view text) {
  std::string out{text};
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string quoted(std::string_view text) {
  std::string quoted_text{"'"};
  quoted_text += text;
  quoted_text += '\'';
  return quoted_text;
}

/// A small m before a watt or a joule is milli: one slip is nine orders of magnitude.
bool looks_like_milli(std::string_view unit) {
  return unit.size() >= 2 && unit[0] == 'm' &&
         (unit[1] == 'w' || unit[1] == 'W' || unit[1] == 'j' || unit[1] == 'J');
}

Result<UnitConversion> steam_mass(const KnownUnit& unit, Utility utility,
                                  const UnitFactors& factors) {
  if (utility == Utility::steam) {
    return UnitConversion{unit.factor * factors.steam_kWh_per_kg, unit.is_rate};
  }
  return failure(ErrorCode::invalid_value,
                 "unit " + quoted(unit.spelling) + " is a mass and only a steam meter may have it");
}

Result<UnitConversion> gas_volume(const KnownUnit& unit, Utility utility,
                                  const UnitFactors& factors) {
  if (utility == Utility::gas && factors.gas_kWh_per_m3) {
    return UnitConversion{unit.factor * *factors.gas_kWh_per_m3, unit.is_rate};
  }
  if (utility == Utility::gas) {
    return failure(ErrorCode::unsupported, "unit " + quoted(unit.spelling) +
                                               " needs the gas's heating value in kWh/m3; give it "
                                               "with the meter");
  }
  return failure(ErrorCode::unsupported,
                 "unit " + quoted(unit.spelling) + " is a volume; only gas has an energy per m3");
}

}  // namespace

Result<UnitConversion> find_unit(std::string_view unit, Utility utility,
                                 const UnitFactors& factors) {
  if (looks_like_milli(unit)) {
    return failure(ErrorCode::invalid_value,
                   "unit " + quoted(unit) + " begins with milli; write a capital M for mega");
  }
  const std::string spelling = lower(unit);
  if (std::find(kFlows.begin(), kFlows.end(), spelling) != kFlows.end()) {
    return failure(ErrorCode::unsupported,
                   "unit " + quoted(unit) +
                       " is a flow, and a flow is energy only with a temperature difference; "
                       "record the meter's heat (kW or kWh)");
  }
  const auto known = std::find_if(kUnits.begin(), kUnits.end(),
                                  [&](const KnownUnit& k) { return k.spelling == spelling; });
  if (known == kUnits.end()) {
    return failure(ErrorCode::invalid_value,
                   "unit " + quoted(unit) +
                       " is not known; use W, kW, MW, Wh, kWh, MWh, MJ, GJ, BTU/h, kBtu/h, kBtu, "
                       "MBtu, therm, ton, ton-hour, kg, lb or m3");
  }
  if (known->measures == Measures::mass) return steam_mass(*known, utility, factors);
  if (known->measures == Measures::gas_volume) return gas_volume(*known, utility, factors);
  return UnitConversion{known->factor, known->is_rate};
}

}  // namespace recald::metering
