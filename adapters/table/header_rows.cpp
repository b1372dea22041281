#include "adapters/table/header_rows.hpp"

#include <algorithm>
#include <set>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/header_units.hpp"
#include "adapters/table/cells/words.hpp"
#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

constexpr std::size_t kHeaderRows = 3;

std::size_t texts_in(const KeptRow& row) {
  return static_cast<std::size_t>(std::count_if(
      row.cells.begin(), row.cells.end(), [](const std::string& cell) { return !cell.empty(); }));
}

/// "[dd.MM.yyyy HH:mm]"
bool is_pattern(std::string_view cell) {
  return to_lower(cell).find("hh") != std::string::npos ||
         to_lower(cell).find("yy") != std::string::npos;
}

bool is_row_of_units(const KeptRow& row, std::size_t time) {
  std::size_t units = 0;
  for (std::size_t column = 0; column < row.cells.size(); ++column) {
    const std::string_view cell = cell_of(row, column);
    if (column == time || cell.empty() || is_pattern(cell)) continue;
    const NameAndUnit parts = split_unit(cell);
    const bool is_one = parts.name.empty() && !parts.unit.empty();
    std::string_view inside = cell;
    if (inside.size() > 2 && (inside.front() == '[' || inside.front() == '(')) {
      inside = inside.substr(1, inside.size() - 2);
    }
    if (!is_one && !is_unit_of_others(inside)) return false;
    if (is_one) ++units;
  }
  return units > 0;
}

bool names_columns(const KeptRow& row, std::size_t time, std::span<const ColumnKinds> kinds) {
  const bool has_date = std::any_of(row.cells.begin(), row.cells.end(),
                                    [](const std::string& cell) { return is_date(cell); });
  if (has_date) return false;
  if (texts_in(row) >= 2) return true;
  // Of two columns the one with times may have no name.
  for (std::size_t column = 0; column < row.cells.size(); ++column) {
    if (column == time || row.cells[column].empty() || column >= kinds.size()) continue;
    return kinds[column].is_mostly(kinds[column].numbers);
  }
  return false;
}

/// Whether a row directly above a header belongs to it: groups of columns, or as many names.
bool is_more_header(const KeptRow& above, const KeptRow& header, std::size_t time) {
  if (above.number + 1 != header.number) return false;
  const std::size_t count = texts_in(above);
  for (const std::string& cell : above.cells) {
    if (!cell.empty() && (is_number(cell) || is_date(cell) || cell.back() == ':')) return false;
  }
  if (above.cells.front().substr(0, 1) == "#") return false;
  const bool is_group = cell_of(above, time).empty() && count >= 1;
  return is_group || (count >= 3 && 2 * count >= texts_in(header));
}

/// Adds a row's texts; a name over several columns stands in the first of them.
/// @param is_lowest  Nothing stands below it to tell columns of one name apart.
void add_texts(const KeptRow& row, bool is_lowest, std::size_t time,
               std::vector<std::string>& texts) {
  std::string_view last;
  for (std::size_t column = 0; column < texts.size(); ++column) {
    std::string_view cell = cell_of(row, column);
    if (column == time) last = {};
    if (cell.empty() && !is_lowest) cell = last;
    if (column != time) last = cell;
    if (cell.empty() || texts[column] == cell) continue;
    texts[column] += (texts[column].empty() ? "" : " ") + std::string{cell};
  }
}

}  // namespace

HeaderRows find_header_rows(std::span<const KeptRow* const> rows, const TimeColumn& times,
                            std::span<const ColumnKinds> kinds) {
  HeaderRows header;
  header.texts.resize(kinds.size());
  header.above = times.first_row;
  if (times.first_row == 0) return header;
  std::size_t lowest = times.first_row - 1;
  const bool has_units = lowest > 0 && is_row_of_units(*rows[lowest], times.column) &&
                         texts_in(*rows[lowest - 1]) + 1 >= texts_in(*rows[lowest]) &&
                         names_columns(*rows[lowest - 1], times.column, kinds);
  if (has_units) header.units = rows[lowest--];
  if (!names_columns(*rows[lowest], times.column, kinds)) return header;
  std::size_t highest = lowest;
  while (highest > 0 && lowest - highest + 1 < kHeaderRows &&
         is_more_header(*rows[highest - 1], *rows[highest], times.column)) {
    --highest;
  }
  header.above = highest;
  std::size_t most = 0;
  const KeptRow* named = nullptr;
  for (std::size_t i = highest; i <= lowest; ++i) {
    add_texts(*rows[i], i == lowest && !has_units, times.column, header.texts);
    const std::set<std::string_view> different{rows[i]->cells.begin(), rows[i]->cells.end()};
    const std::size_t names =
        2 * different.size() + (cell_of(*rows[i], times.column).empty() ? 0 : 3);
    if (names < most) continue;
    most = names;
    named = rows[i];
  }
  for (const std::string& cell : named->cells) header.names.push_back(squeezed(cell));
  for (std::string& text : header.texts) text = squeezed(text);
  return header;
}

UnitAbove unit_above(std::span<const KeptRow* const> rows) {
  UnitAbove found;
  const auto add = [&](std::string unit, const KeptRow& row) {
    if (unit.empty() || unit == found.unit) return true;
    if (!found.unit.empty()) return false;
    found = {std::move(unit), row.number};
    return true;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!add(unit_said(rows[i]->cells), *rows[i])) return {};
    if (i == 0) continue;
    // A name above its value: "…;Unité;…" over "…;W;…".
    for (std::size_t column = 0; column < rows[i]->cells.size(); ++column) {
      const std::string_view cell = cell_of(*rows[i], column);
      const bool is_value = is_unit(cell) && is_word_for_unit(cell_of(*rows[i - 1], column));
      if (is_value && !add(std::string{cell}, *rows[i])) return {};
    }
  }
  return found;
}

std::string squeezed(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::string_view before = text;
    const std::uint32_t point = take_character(text);
    if (is_unseen(point)) continue;
    const bool is_blank = point <= ' ' || is_wide_blank(point);
    if (!is_blank) {
      out += before.substr(0, before.size() - text.size());
    } else if (!out.empty() && out.back() != ' ') {
      out += ' ';
    }
  }
  if (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

}  // namespace recald::table
