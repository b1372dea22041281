#include "core/metering/units.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "core/text/ascii.hpp"

namespace recald::metering {
namespace {

// International Table BTU: 1055.05585262 J.
constexpr double kBtu_kWh = 1055.05585262 / 3.6e6;
constexpr double kTon_kW = 12'000.0 * kBtu_kWh;  // ton of refrigeration, 3.516853 kW
constexpr double kPound_kg = 0.45359237;
constexpr double kCubicFoot_m3 = 0.028316846592;
constexpr double kCalorie_kWh = 4.1868 / 3.6e6;  // International Table

enum class Measures { energy, mass, gas_volume };

struct KnownUnit {
  std::string_view spelling;  // normalised by `plain`
  double factor;              // kW or kWh; kg(/h); m3(/h)
  bool is_rate;
  Measures measures = Measures::energy;
};

constexpr std::array kUnits{
    KnownUnit{"w", 1e-3, true},
    KnownUnit{"kw", 1.0, true},
    KnownUnit{"kwh/h", 1.0, true},
    KnownUnit{"mw", 1e3, true},
    KnownUnit{"gw", 1e6, true},
    KnownUnit{"btu/h", kBtu_kWh, true},
    KnownUnit{"btuh", kBtu_kWh, true},
    KnownUnit{"kbtu/h", 1e3 * kBtu_kWh, true},
    KnownUnit{"kbtuh", 1e3 * kBtu_kWh, true},
    KnownUnit{"mbh", 1e3 * kBtu_kWh, true},
    KnownUnit{"mbtu/h", 1e6 * kBtu_kWh, true},
    KnownUnit{"mmbtu/h", 1e6 * kBtu_kWh, true},
    KnownUnit{"therm/h", 1e5 * kBtu_kWh, true},
    KnownUnit{"ton", kTon_kW, true},
    KnownUnit{"tr", kTon_kW, true},
    KnownUnit{"kj/h", 1.0 / 3.6e3, true},
    KnownUnit{"mj/h", 1.0 / 3.6, true},
    KnownUnit{"gj/h", 1.0 / 3.6e-3, true},
    KnownUnit{"wh", 1e-3, false},
    KnownUnit{"kwh", 1.0, false},
    KnownUnit{"kwhr", 1.0, false},
    KnownUnit{"mwh", 1e3, false},
    KnownUnit{"gwh", 1e6, false},
    KnownUnit{"j", 1.0 / 3.6e6, false},
    KnownUnit{"kj", 1.0 / 3.6e3, false},
    KnownUnit{"mj", 1.0 / 3.6, false},
    KnownUnit{"gj", 1.0 / 3.6e-3, false},
    KnownUnit{"kcal", 1e3 * kCalorie_kWh, false},
    KnownUnit{"gcal", 1e9 * kCalorie_kWh, false},
    KnownUnit{"btu", kBtu_kWh, false},
    KnownUnit{"kbtu", 1e3 * kBtu_kWh, false},
    KnownUnit{"mbtu", 1e6 * kBtu_kWh, false},
    KnownUnit{"mmbtu", 1e6 * kBtu_kWh, false},
    KnownUnit{"therm", 1e5 * kBtu_kWh, false},
    KnownUnit{"dekatherm", 1e6 * kBtu_kWh, false},
    KnownUnit{"dth", 1e6 * kBtu_kWh, false},
    KnownUnit{"tonhour", kTon_kW, false},
    KnownUnit{"tonh", kTon_kW, false},
    KnownUnit{"trh", kTon_kW, false},
    KnownUnit{"tonday", 24.0 * kTon_kW, false},
    KnownUnit{"kg", 1.0, false, Measures::mass},
    KnownUnit{"kg/h", 1.0, true, Measures::mass},
    KnownUnit{"tonne", 1e3, false, Measures::mass},
    KnownUnit{"tonne/h", 1e3, true, Measures::mass},
    KnownUnit{"lb", kPound_kg, false, Measures::mass},
    KnownUnit{"lb/h", kPound_kg, true, Measures::mass},
    KnownUnit{"klb", 1e3 * kPound_kg, false, Measures::mass},
    KnownUnit{"klb/h", 1e3 * kPound_kg, true, Measures::mass},
    KnownUnit{"m3", 1.0, false, Measures::gas_volume},
    KnownUnit{"m3/h", 1.0, true, Measures::gas_volume},
    KnownUnit{"cf", kCubicFoot_m3, false, Measures::gas_volume},
    KnownUnit{"cf/h", kCubicFoot_m3, true, Measures::gas_volume},
    KnownUnit{"ccf", 1e2 * kCubicFoot_m3, false, Measures::gas_volume},
    KnownUnit{"ccf/h", 1e2 * kCubicFoot_m3, true, Measures::gas_volume},
    KnownUnit{"mcf", 1e3 * kCubicFoot_m3, false, Measures::gas_volume},
    KnownUnit{"mcf/h", 1e3 * kCubicFoot_m3, true, Measures::gas_volume},
};

/// Other spellings of these units.
struct Synonym {
  std::string_view written;  // normalised by `plain`
  std::string_view known;
};

constexpr std::array kSynonyms{
    Synonym{"cbm", "m3"},
    Synonym{"nm3", "m3"},
    Synonym{"sm3", "m3"},
    Synonym{"cubicmeter", "m3"},
    Synonym{"cubicmetre", "m3"},
    Synonym{"ft3", "cf"},
    Synonym{"scf", "cf"},
    Synonym{"cubicfoot", "cf"},
    Synonym{"cubicfeet", "cf"},
    Synonym{"kcf", "mcf"},
    Synonym{"hcf", "ccf"},
    Synonym{"scfh", "cf/h"},
    Synonym{"pound", "lb"},
    Synonym{"kilopound", "klb"},
    Synonym{"kpound", "klb"},
    Synonym{"t", "tonne"},
    Synonym{"t/h", "tonne/h"},
    Synonym{"metricton", "tonne"},
    Synonym{"tonhr", "tonh"},
    Synonym{"trhr", "trh"},
    Synonym{"rth", "trh"},
    Synonym{"tonrefrigeration", "ton"},
    Synonym{"rt", "tr"},
    Synonym{"thm", "therm"},
    Synonym{"decatherm", "dekatherm"},
    Synonym{"watt", "w"},
    Synonym{"kilowatt", "kw"},
    Synonym{"megawatt", "mw"},
    Synonym{"watthour", "wh"},
    Synonym{"kilowatthour", "kwh"},
    Synonym{"megawatthour", "mwh"},
    Synonym{"kwstd", "kwh"},
    Synonym{"wattstunde", "wh"},
    Synonym{"wattstunden", "wh"},
    Synonym{"wattheure", "wh"},
    Synonym{"megawattstunden", "mwh"},
    Synonym{"kubikmeter", "m3"},
    Synonym{"metrecube", "m3"},
    Synonym{"metrocubo", "m3"},
    Synonym{"kubiekemeter", "m3"},
    Synonym{"gigajoule", "gj"},
    Synonym{"megajoule", "mj"},
    Synonym{"kilojoule", "kj"},
};

constexpr std::array<std::string_view, 9> kFlows{"l/s", "l/h", "l/min", "gpm",   "m3/s",
                                                 "gal", "l",   "liter", "gallon"};

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

/// Lower case, cube as 3, hour as h, without blanks, hyphens, dots and plural s.
std::string plain(std::string_view text) {
  std::string out = to_lower(text);
  replace_all(out, "\xC2\xB3", "3");  // superscript three
  replace_all(out, "^3", "3");
  replace_all(out, "\xC2\xB7", "");  // a dot between kW and h
  std::erase_if(out,
                [](char c) { return c == ' ' || c == '-' || c == '_' || c == '.' || c == '*'; });
  replace_all(out, "/hr", "/h");
  replace_all(out, "/hour", "/h");
  replace_all(out, "perhour", "/h");
  const std::size_t slash = out.find('/');
  const std::size_t end = slash == std::string::npos ? out.size() : slash;
  // "lbs", "tons", "therms", "ton-hours"; normalised "l/s" no longer ends in s.
  if (end > 2 && out[end - 1] == 's') out.erase(end - 1, 1);
  return out;
}

/// A kilowatt hour in other languages, normalised by `plain`: they begin alike and end in an hour.
bool is_kilowatt_hour(std::string_view spelling) {
  constexpr std::array<std::string_view, 4> kKilowatts{"kilowat", "kilovat", "chilowat",
                                                       "quilowat"};
  constexpr std::array<std::string_view, 8> kHours{"stunde", "heure", "uur",    "time",
                                                   "timm",   "tunti", "godzin", "ora"};
  const auto begins = [&](std::string_view kilowatt) {
    return spelling.substr(0, kilowatt.size()) == kilowatt;
  };
  const auto has = [&](std::string_view hour) {
    return spelling.find(hour) != std::string_view::npos;
  };
  return std::any_of(kKilowatts.begin(), kKilowatts.end(), begins) &&
         std::any_of(kHours.begin(), kHours.end(), has);
}

const KnownUnit* find_known(std::string_view spelling) {
  if (is_kilowatt_hour(spelling)) spelling = "kwh";
  for (const Synonym& synonym : kSynonyms) {
    if (synonym.written == spelling) spelling = synonym.known;
  }
  const auto known = std::find_if(kUnits.begin(), kUnits.end(),
                                  [&](const KnownUnit& k) { return k.spelling == spelling; });
  return known == kUnits.end() ? nullptr : &*known;
}

std::string quoted(std::string_view text) {
  std::string quoted_text{"'"};
  quoted_text += text;
  quoted_text += '\'';
  return quoted_text;
}

/// A small m before a watt or a joule would be milli: such a slip is nine orders of magnitude.
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
                                               " needs the gas's heating value; give "
                                               "gas_kWh_per_m3 with the meter, as the bill says "
                                               "(1000 BTU/ft3 are 10.35)");
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
  const std::string spelling = plain(unit);
  if (std::find(kFlows.begin(), kFlows.end(), spelling) != kFlows.end()) {
    return failure(ErrorCode::unsupported,
                   "unit " + quoted(unit) +
                       " is a flow, and a flow is energy only with a temperature difference; "
                       "record the meter's heat (kW or kWh)");
  }
  const KnownUnit* known = find_known(spelling);
  if (known == nullptr) {
    return failure(ErrorCode::invalid_value,
                   "unit " + quoted(unit) +
                       " is not known; use W, kW, MW, Wh, kWh, MWh, MJ, GJ, BTU/h, kBtu/h, kBtu, "
                       "MMBtu, therm, ton, ton-hour, kg, lb, klb, m3, CCF or MCF");
  }
  if (known->measures == Measures::mass) return steam_mass(*known, utility, factors);
  if (known->measures == Measures::gas_volume) return gas_volume(*known, utility, factors);
  return UnitConversion{known->factor, known->is_rate};
}

}  // namespace recald::metering
