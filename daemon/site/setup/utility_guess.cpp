#include "daemon/site/setup/utility_guess.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "core/metering/units.hpp"
#include "core/text/ascii.hpp"

namespace recald::daemon {
namespace {

using metering::Utility;

struct Word {
  std::string_view text;
  Utility utility;
};

/// The first that a name contains decides: chilled water is no water, a gas boiler's fuel is gas.
constexpr std::array kWords{
    Word{"chilled", Utility::chilled_water},
    Word{"chw", Utility::chilled_water},
    Word{"cooling", Utility::chilled_water},
    Word{"k\xC3\xA4lte", Utility::chilled_water},
    Word{"kaelte", Utility::chilled_water},
    Word{"froid", Utility::chilled_water},
    Word{"steam", Utility::steam},
    Word{"dampf", Utility::steam},
    Word{"vapeur", Utility::steam},
    Word{"gas", Utility::gas},
    Word{"gaz", Utility::gas},
    Word{"heat", Utility::heating},
    Word{"w\xC3\xA4rme", Utility::heating},
    Word{"waerme", Utility::heating},
    Word{"chaleur", Utility::heating},
    Word{"hhw", Utility::heating},
    Word{"hot water", Utility::heating},
    Word{"hot_water", Utility::heating},
    Word{"boiler", Utility::heating},
    Word{"elec", Utility::electricity},
    Word{"strom", Utility::electricity},
    Word{"wirkarbeit", Utility::electricity},
    Word{"power", Utility::electricity},
    Word{"pv", Utility::electricity},
    Word{"solar", Utility::electricity},
    Word{"light", Utility::electricity},
    Word{"water", Utility::water},
};

std::optional<Utility> by_name(std::string_view name) {
  const std::string lower = to_lower(name);
  for (const Word& word : kWords) {
    if (lower.find(word.text) != std::string::npos) return word.utility;
  }
  return {};
}

/// Units that one utility alone is sold in.
std::optional<Utility> by_unit(std::string_view unit) {
  const std::string lower = to_lower(unit);
  const auto has = [&](std::string_view part) { return lower.find(part) != std::string::npos; };
  if (has("tonne")) return Utility::steam;
  if (has("ton") || lower.substr(0, 2) == "tr" || lower == "rth") return Utility::chilled_water;
  if (has("lb") || has("pound") || lower == "kg" || lower == "t") return Utility::steam;
  if (has("therm") || has("cf") || has("m3") || has("m\xC2\xB3") || has("ft3") || has("dth")) {
    return Utility::gas;
  }
  if (has("mmbtu")) return Utility::gas;
  return {};
}

bool fits(Utility utility, std::string_view unit) {
  const metering::UnitFactors factors{.gas_kWh_per_m3 = 10.0};
  return unit.empty() || metering::find_unit(unit, utility, factors).has_value();
}

}  // namespace

UtilityGuess guess_utility(std::string_view name, std::string_view unit) {
  const auto named = by_name(name);
  if (named && fits(*named, unit)) return {*named, "by its name"};
  if (const auto sold = by_unit(unit); sold && fits(*sold, unit)) {
    return {*sold, "by its unit; its name does not say"};
  }
  return {Utility::electricity, "guessed: neither its name nor its unit says"};
}

}  // namespace recald::daemon
