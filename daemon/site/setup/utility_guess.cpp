#include "daemon/site/setup/utility_guess.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "adapters/table/cells/words.hpp"
#include "core/metering/units.hpp"
#include "core/text/ascii.hpp"

namespace recald::daemon {
namespace {

using metering::Utility;

struct WordsOfUtility {
  Utility utility;
  std::string_view words;  ///< Set apart by bars; a blank is where a word begins or ends.
};

/// The first that a name contains decides: a chiller's power is electricity, chilled water is no
/// water, a gas boiler's fuel is gas. In the languages of `words.hpp`.
constexpr std::array kWords{
    WordsOfUtility{Utility::heating, "waermestrom"},
    WordsOfUtility{Utility::chilled_water, "kaeltestrom"},
    WordsOfUtility{Utility::water, "volumenstrom"},
    WordsOfUtility{Utility::electricity,
                   "elec|elekt|elett|strom|stroom|saehkoe|sahko|wirkarbeit|wirkleistung|heat pump|"
                   "heatpump|waermepumpe|pompe a chaleur|bomba de calor|pompa di calore|warmtepomp|"
                   "varmepumpe|vaermepump|laempoepump|lampopump|pompa ciepla|bomba calor"},
    WordsOfUtility{Utility::chilled_water,
                   "chilled| chw|cooling|kaelte|kuehl|froid|refroidi| frio|refrigera|raffredd|"
                   "freddo|koeling| koude|arrefec| kyla|kyla |jaeaehdy|jaahdy|chlod"},
    WordsOfUtility{Utility::steam,
                   "steam|dampf|vapeur| vapor|stoom| damp |aanga|hoeyry|hoyry| para "},
    WordsOfUtility{Utility::gas, "gas|gaz|kaasu|metano"},
    WordsOfUtility{Utility::heating,
                   "heat|heiz|waerme|chaleur|chauff|hhw|hot water|warmwasser|eau chaude|boiler|"
                   "calefac|calor|riscald|acqua calda|agua caliente|verwarm|warmte|aquec|varme|"
                   "vaerme|laempoe|kaukolamp|cieplo|ogrzew"},
    WordsOfUtility{Utility::electricity, "power|pv|solar|light|photovolt|fotovolt|beleucht"},
    WordsOfUtility{Utility::water,
                   "water|wasser| eau |agua |acqua| vand|vand |vatten| vesi| woda "},
};

bool has_one(std::string_view text, std::string_view words) {
  for (;;) {
    const std::size_t bar = words.find('|');
    if (text.find(words.substr(0, bar)) != std::string_view::npos) return true;
    if (bar == std::string_view::npos) return false;
    words.remove_prefix(bar + 1);
  }
}

std::optional<Utility> by_name(std::string_view name) {
  const std::string text = table::folded(name);
  for (const WordsOfUtility& one : kWords) {
    if (has_one(text, one.words)) return one.utility;
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
