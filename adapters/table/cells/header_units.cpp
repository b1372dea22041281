#include "adapters/table/cells/header_units.hpp"

#include <algorithm>
#include <array>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/words.hpp"
#include "core/metering/units.hpp"
#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

constexpr std::string_view kUnitSigns = " _,;:-./|\n";

bool is_sign(char c) { return kUnitSigns.find(c) != std::string_view::npos; }

std::string_view without_signs(std::string_view text) {
  while (!text.empty() && is_sign(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_sign(text.back())) text.remove_suffix(1);
  return text;
}

bool ends_in_word(std::string_view name, std::initializer_list<std::string_view> words) {
  const std::string text = folded(name);
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
    return text.size() >= word.size() && text.substr(text.size() - word.size()) == word;
  });
}

/// "Real energy in": the word that ties a unit to its name is no part of it.
std::string name_before(std::string_view before) {
  before = without_signs(before);
  for (const std::string_view word : {" in", " en", " i", " em", " w", " as", "In"}) {
    if (before.size() > word.size() && before.substr(before.size() - word.size()) == word) {
      before.remove_suffix(word.size());
      break;
    }
  }
  return std::string{without_signs(before)};
}

/// "x10", "*100", and a power of ten where nothing else stands before it.
bool is_factor(std::string_view before) {
  before = without_signs(before);
  const std::size_t space = before.find_last_of(" (");
  std::string_view word = before.substr(space == std::string_view::npos ? 0 : space + 1);
  const bool has_sign =
      word.size() > 1 && (word.front() == 'x' || word.front() == 'X' || word.front() == '*');
  if (has_sign) word.remove_prefix(1);
  if (word.empty() || word.find_first_not_of("0123456789.,^") != std::string_view::npos)
    return false;
  return has_sign || name_before(before.substr(0, before.size() - word.size())).empty();
}

/// Whether what stands before or behind a unit makes another quantity of it.
bool changes_unit(std::string_view before, std::string_view behind) {
  const bool is_after_slash = !before.empty() && (before.back() == '/' || before.back() == '*');
  if (is_after_slash) return true;
  if (ends_in_word(before, {" per ", " pro ", " par ", " por ", " je ", " pr ", " za ", " x "})) {
    return true;
  }
  if (is_factor(before)) return true;
  behind = csv::trimmed(behind);
  return !behind.empty() &&
         (behind.front() == '*' || behind.front() == '/' || behind.front() == 'x') &&
         behind.size() > 1;
}

struct Brackets {
  std::string_view open;
  std::string_view close;
};
constexpr std::array kBrackets{Brackets{"(", ")"},
                               Brackets{"[", "]"},
                               Brackets{"{", "}"},
                               Brackets{"<", ">"},
                               Brackets{"\xC2\xAB", "\xC2\xBB"},
                               Brackets{"\xEF\xBC\x88", "\xEF\xBC\x89"}};

NameAndUnit unit_at_end(std::string_view text);

/// The last brackets of a kind that have a unit in them, or a text that ends in one.
NameAndUnit unit_in_brackets(std::string_view text) {
  for (const auto& [open, close] : kBrackets) {
    for (std::size_t end = text.rfind(close); end != std::string_view::npos && end > 0;
         end = text.rfind(close, end - 1)) {
      const std::size_t begin = text.rfind(open, end - 1);
      if (begin == std::string_view::npos) break;
      const std::string_view inside =
          csv::trimmed(text.substr(begin + open.size(), end - begin - open.size()));
      std::string unit = is_unit(inside) ? std::string{inside} : unit_at_end(inside).unit;
      if (unit.empty()) continue;
      std::string name{without_signs(text.substr(0, begin))};
      const std::string_view rest = without_signs(text.substr(end + close.size()));
      if (!rest.empty()) name += (name.empty() ? "" : " ") + std::string{rest};
      return {std::move(name), std::move(unit), true};
    }
  }
  return {};
}

/// The longest ending that is a unit: "ton-hours", not "hours". A single letter is more often a
/// wing or a storey than watts.
NameAndUnit unit_at_end(std::string_view text) {
  for (std::size_t cut = text.find_first_of(kUnitSigns); cut != std::string_view::npos;
       cut = text.find_first_of(kUnitSigns, cut + 1)) {
    const std::string_view unit = csv::trimmed(text.substr(cut + 1));
    if (cut == 0 || unit.empty() || is_sign(unit.front()) || !is_unit(unit)) continue;
    const std::string_view before = text.substr(0, cut + (text[cut] == '/' ? 1 : 0));
    const bool is_power = meanings_of(before).has(Meaning::use) && unit == "W";
    if (unit.size() < 2 && !is_power) continue;
    if (changes_unit(before, {})) return {};
    return {name_before(before), std::string{unit}};
  }
  return {};
}

/// "kWh delivered", "energy_kWh_total": units that are no other word.
NameAndUnit unit_inside(std::string_view text) {
  constexpr auto kPlainUnits =
      std::to_array<std::string_view>({"kwh", "mwh", "kw", "wh", "therms"});
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find_first_of(kUnitSigns, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    const bool is_one = std::any_of(kPlainUnits.begin(), kPlainUnits.end(),
                                    [&](auto unit) { return equals_ignoring_case(unit, word); });
    const std::string_view before = text.substr(0, begin);
    const std::string_view behind = text.substr(end);
    if (is_one && is_unit(word) && !changes_unit(before, behind)) {
      std::string name = name_before(before);
      const std::string_view rest = without_signs(behind);
      if (!rest.empty()) name += (name.empty() ? "" : " ") + std::string{rest};
      return {std::move(name), std::string{word}};
    }
    begin = end + 1;
  }
  return {};
}

}  // namespace

bool is_unit(std::string_view text) {
  if (text.empty() || text.size() > 24) return false;
  constexpr std::array kUtilities{metering::Utility::electricity, metering::Utility::gas,
                                  metering::Utility::steam};
  const metering::UnitFactors factors{.gas_kWh_per_m3 = 10.0};
  return std::any_of(kUtilities.begin(), kUtilities.end(), [&](metering::Utility utility) {
    return metering::find_unit(text, utility, factors).has_value();
  });
}

bool is_unit_of_others(std::string_view text) {
  if (text.empty() || text.size() > 16 || is_unit(text)) return false;
  const Meanings meanings = meanings_of(text);
  if (meanings.has_any({Meaning::other, Meaning::cost, Meaning::emission})) return true;
  constexpr auto kOthers = std::to_array<std::string_view>(
      {"v",    "kv",  "a",   "ma",   "va",    "hz",    "pf",  "bar",  "pa",   "kpa",
       "ppm",  "lux", "l",   "l/h",  "l/s",   "gal",   "gpm", "m/s",  "rpm",  "c",
       "f",    "k",   "p",   "varh", "kvarh", "mvarh", "var", "kvar", "kvah", "vah",
       "w/m2", "db",  "min", "s",    "h",     "g",     "kr",  "ft"});
  const std::string lower = to_lower(csv::trimmed(text));
  return std::find(kOthers.begin(), kOthers.end(), lower) != kOthers.end();
}

NameAndUnit split_unit(std::string_view header) {
  const std::string_view text = csv::trimmed(header);
  if (is_unit(text)) return {"", std::string{text}};
  if (NameAndUnit parts = unit_in_brackets(text); !parts.unit.empty()) {
    if (parts.name.empty()) parts.is_unit_in_brackets = true;
    return parts;
  }
  if (!meanings_of(text).has_any({Meaning::cost, Meaning::emission})) {
    if (NameAndUnit parts = unit_at_end(text); !parts.unit.empty()) return parts;
    if (NameAndUnit parts = unit_inside(text); !parts.unit.empty()) return parts;
  }
  return {std::string{text}, ""};
}

bool is_word_for_unit(std::string_view text) {
  return text.size() <= 24 && meanings_of(text).has(Meaning::unit);
}

std::string unit_said(const std::vector<std::string>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string_view cell = csv::trimmed(cells[i]);
    if (cell.empty() || cell.size() > 120) continue;
    const NameAndUnit parts = split_unit(cell);
    if (parts.name.empty() && !parts.unit.empty()) {
      if (i > 0 && is_word_for_unit(cells[i - 1])) return parts.unit;
      continue;
    }
    const std::size_t colon = cell.find_first_of(":=");
    if (colon != std::string_view::npos && is_word_for_unit(cell.substr(0, colon))) {
      const std::string_view unit = csv::trimmed(cell.substr(colon + 1));
      if (is_unit(unit)) return std::string{unit};
      continue;
    }
    // A sentence: its unit is in brackets, or behind "in".
    if (parts.unit.empty()) continue;
    const bool is_tied =
        parts.is_unit_in_brackets || is_word_for_unit(parts.name) ||
        ends_in_word(cell.substr(0, cell.size() - std::min(cell.size(), parts.unit.size())),
                     {" in ", " en ", " i ", " em ", " w "});
    if (is_tied) return parts.unit;
  }
  return {};
}

}  // namespace recald::table
