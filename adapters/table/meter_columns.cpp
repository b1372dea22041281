#include "adapters/table/meter_columns.hpp"

#include <algorithm>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/header_units.hpp"
#include "adapters/table/cells/words.hpp"

namespace recald::table {
namespace {

/// "kvarh" of "Reactive (kvarh)" and of "[kvarh]".
std::string_view in_last_brackets(std::string_view text) {
  const std::size_t begin = text.find_last_of("([");
  const std::size_t end = text.find_last_of(")]");
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) return {};
  return csv::trimmed(text.substr(begin + 1, end - begin - 1));
}

/// "p/kWh", "ct / kWh": what a unit of energy costs.
bool is_unit_price(std::string_view unit) {
  const std::size_t slash = unit.rfind('/');
  if (slash == std::string_view::npos || slash == 0) return false;
  return is_unit(csv::trimmed(unit.substr(slash + 1))) &&
         !is_unit(csv::trimmed(unit.substr(0, slash)));
}

/// The numbers of a column that has no unit: of rows, of meters, of parts of a date, of states.
std::string_view why_no_amounts(std::string_view header, const ColumnKinds& kinds) {
  const Meanings meanings = meanings_of(header);
  const std::size_t different = kinds.texts.size();
  // "Meter 1" may have few different amounts, "meter id" has numbers of one length.
  const std::size_t figures = kinds.texts.empty() ? 0 : kinds.texts.begin()->size();
  const bool are_alike =
      std::all_of(kinds.texts.begin(), kinds.texts.end(),
                  [&](const std::string& text) { return text.size() == figures; });
  const bool may_be_id = meanings.has(Meaning::identifier) ? figures > 2 : are_alike && figures > 3;
  const bool is_called_so = meanings.has_any({Meaning::identifier, Meaning::meter}) && may_be_id &&
                            20 * different <= kinds.filled;
  if (kinds.is_identifier() || is_called_so) return "an identifier";
  if (meanings.has(Meaning::date_part) && different <= 60) return "part of the date";
  if (meanings.has(Meaning::clock) && kinds.repeats()) return "part of the time";
  if (meanings.has(Meaning::status) && different <= 12) return "a status";
  if (meanings.has(Meaning::tariff) && different <= 8) return "a tariff";
  return {};
}

}  // namespace

std::string_view why_no_meter(std::string_view header, std::string_view below,
                              const ColumnKinds& kinds) {
  const NameAndUnit parts = split_unit(header);
  const Meanings meanings = meanings_of(header);
  if (meanings.has(Meaning::cost) && !parts.is_unit_in_brackets) return "money";
  if (meanings.has(Meaning::emission)) return "emissions";
  const std::string_view inside = in_last_brackets(below);
  if (is_unit_price(in_last_brackets(header)) || is_unit_price(inside.empty() ? below : inside)) {
    return "money";
  }
  if (is_unit_of_others(inside.empty() ? below : inside)) return "no energy";
  const bool has_unit =
      !parts.unit.empty() || kinds.with_unit > 0 || !split_unit(below).unit.empty();
  if (has_unit) return {};
  if (meanings.has(Meaning::other) || is_unit_of_others(in_last_brackets(header))) {
    return "no energy";
  }
  if (kinds.counts_rows()) return "the number of a row";
  // What has five figures or more and stays the same is a number of something.
  constexpr std::size_t kFiguresMin = 5;
  const bool is_one_number = kinds.is_whole && kinds.filled > 100 && kinds.texts.size() == 1 &&
                             kinds.texts.begin()->size() >= kFiguresMin;
  if (is_one_number && !meanings.has(Meaning::use)) return "an identifier";
  const bool may_be_amounts = meanings.has(Meaning::use) || !kinds.is_whole;
  return may_be_amounts ? std::string_view{} : why_no_amounts(header, kinds);
}

bool is_column_of_units(std::string_view header, const ColumnKinds& kinds) {
  if (kinds.filled == 0 || kinds.words != kinds.filled) return false;
  // "reading_type.unit" of a document's objects
  const bool is_called_so = is_word_for_unit(header.substr(header.rfind('.') + 1));
  bool has_one = false;
  for (const std::string& text : kinds.texts) {
    // A single letter is more often a flag than watts.
    if (text.size() < 2 && !is_called_so) return false;
    const bool is_one = is_unit(text);
    if (!is_one && !is_unit_of_others(text)) return false;
    has_one = has_one || is_one;
  }
  return has_one;
}

bool is_column_of_times(const ColumnKinds& kinds) {
  if (!kinds.is_mostly(kinds.words)) return false;
  return kinds.is_mostly(kinds.times_of_day) ||
         std::all_of(kinds.texts.begin(), kinds.texts.end(),
                     [](const std::string& text) { return is_date(text); });
}

}  // namespace recald::table
