#include "adapters/table/cells/column_kinds.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/cell_number.hpp"
#include "adapters/table/cells/header_units.hpp"
#include "adapters/table/cells/stamps.hpp"

namespace recald::table {
namespace {

constexpr double kMost = 0.8;  // share of a column's cells that must be of one kind

std::optional<std::int64_t> whole_number_of(std::string_view cell) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  const bool is_whole = error == std::errc{} && end == cell.data() + cell.size();
  return is_whole ? std::optional{number} : std::nullopt;
}

/// 1234 and "1,234", whatever the sign between thousands.
std::optional<std::int64_t> counted_number_of(std::string_view cell) {
  std::string figures;
  std::size_t in_group = 0;
  bool is_grouped = false;
  for (const char c : cell) {
    if (c >= '0' && c <= '9') {
      figures += c;
      ++in_group;
    } else if ((c == ',' || c == '.' || c == ' ' || c == '\'') && !figures.empty() &&
               (is_grouped ? in_group == 3 : in_group <= 3)) {
      is_grouped = true;
      in_group = 0;
    } else {
      return {};
    }
  }
  if (is_grouped && in_group != 3) return {};
  return whole_number_of(figures);
}

bool is_bare_number(std::string_view cell) {
  const DecimalSigns signs = possible_decimal_signs(cell);
  return signs.point || signs.comma;
}

class ColumnCounter {
 public:
  void take(std::string_view cell, ColumnKinds& kinds) {
    ++kinds.filled;
    const NumberAndUnit parts = split_number(cell);
    const bool is_with_unit = !parts.number.empty() && !parts.unit.empty() && is_unit(parts.unit);
    if (is_bare_number(cell) || (is_with_unit && is_bare_number(parts.number))) {
      ++kinds.numbers;
      if (is_with_unit) {
        ++kinds.with_unit;
        ++kinds.units[std::string{parts.unit}];
      }
    } else {
      ++kinds.words;
    }
    if (csv::is_digits(cell) && cell.size() >= 8) ++kinds.long_figures;
    const auto whole = whole_number_of(cell);
    kinds.is_whole = kinds.is_whole && whole.has_value();
    const auto counted = counted_number_of(cell);
    if (counted && last_ && *counted == *last_ + 1) ++kinds.steps;
    if (counted && last_ && *counted == *last_ - 1) ++kinds.steps_back;
    last_ = counted;
    if (parse_clock(cell)) ++kinds.times_of_day;
    if (kinds.texts.size() < 100) kinds.texts.insert(std::string{cell});
  }

 private:
  std::optional<std::int64_t> last_;
};

}  // namespace

bool is_number(std::string_view cell) {
  if (is_bare_number(cell)) return true;
  const NumberAndUnit parts = split_number(cell);
  return !parts.unit.empty() && !parts.number.empty() && is_bare_number(parts.number) &&
         is_unit(parts.unit);
}

bool is_date(std::string_view cell) {
  if (cell.size() < 6 || cell.size() > 100) return false;
  if (is_bare_number(cell) && (cell.size() < 8 || !csv::is_digits(cell))) return false;
  return is_stamp(cell, TimeFormat::year_first) || is_stamp(cell, TimeFormat::day_first) ||
         is_stamp(cell, TimeFormat::month_first);
}

bool ColumnKinds::is_mostly(std::size_t count) const {
  return filled > 0 && static_cast<double>(count) >= kMost * static_cast<double>(filled);
}

bool ColumnKinds::repeats() const { return texts.size() < 100 && texts.size() * 3 <= filled; }

bool ColumnKinds::counts_rows() const {
  return filled > 3 && std::max(steps, steps_back) + 1 >= filled * 99 / 100;
}

bool ColumnKinds::is_identifier() const {
  return filled > 0 && long_figures == filled && repeats();
}

std::vector<ColumnKinds> kinds_of(std::span<const KeptRow* const> rows, std::size_t width) {
  std::vector<ColumnKinds> kinds(width);
  std::vector<ColumnCounter> counters(width);
  for (const KeptRow* row : rows) {
    for (std::size_t column = 0; column < row->cells.size(); ++column) {
      const std::string_view cell = cell_of(*row, column);
      if (!is_blank(cell)) counters[column].take(cell, kinds[column]);
    }
  }
  return kinds;
}

}  // namespace recald::table
