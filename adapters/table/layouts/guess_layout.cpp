#include "adapters/table/layouts/guess_layout.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/cell_number.hpp"
#include "adapters/table/layouts/day_columns.hpp"
#include "adapters/table/layouts/time_columns.hpp"
#include "adapters/table/layouts/turned_table.hpp"

namespace recald::table {
namespace {

constexpr std::size_t kHeaderRowsSeen = 200;
constexpr std::array kOrders{TimeFormat::year_first, TimeFormat::day_first,
                             TimeFormat::month_first};

std::vector<std::string_view> cells_of(const KeptRow& row) {
  return {row.cells.begin(), row.cells.end()};
}

bool reads_as_number(std::string_view cell) {
  const DecimalSigns signs = possible_decimal_signs(cell);
  return signs.point || signs.comma;
}

bool reads_as_date(std::string_view cell) {
  return cell.size() >= 6 && std::ranges::any_of(kOrders, [&](TimeFormat format) {
           return parse_stamp(cell, format).has_value();
         });
}

/// Columns beside the readings that may be dates, names or units: those of sums would pass for
/// meters.
std::vector<std::size_t> telling_columns(std::span<const KeptRow> data, std::size_t width,
                                         const auto& is_reading) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < width; ++i) {
    if (is_reading(i)) continue;
    std::size_t filled = 0;
    std::size_t numbers = 0;
    for (const KeptRow& row : data) {
      if (i >= row.cells.size() || is_blank(row.cells[i])) continue;
      ++filled;
      const bool is_number = reads_as_number(row.cells[i]);
      if (is_number && !(row.cells[i].size() == 8 && reads_as_date(row.cells[i]))) ++numbers;
    }
    if (filled > 0 && 2 * numbers < filled) columns.push_back(i);
  }
  return columns;
}

std::string cell_at(const KeptRow& row, std::size_t column) {
  return column < row.cells.size() ? row.cells[column] : "";
}

std::string clock_words(int time_min) {
  std::string text = std::to_string(100'000 + time_min / 60 * 100 + time_min % 60).substr(2);
  text.insert(2, ":");
  return text;
}

/// The rows with the times of days in columns, with a row for each time.
std::optional<LayoutGuess> day_guess(std::span<const KeptRow> rows, std::size_t header,
                                     const DayColumns& day) {
  const auto data = rows.subspan(header + 1);
  const KeptRow& names = rows[header];
  const auto others =
      telling_columns(data, names.cells.size(), [&](std::size_t i) { return day.covers(i); });
  const bool has_dates = std::ranges::any_of(others, [&](std::size_t column) {
    return std::ranges::any_of(
        data, [&](const KeptRow& row) { return reads_as_date(cell_at(row, column)); });
  });
  if (!has_dates) return {};
  LayoutGuess guess{.layout = Layout::row_a_day, .because = {}, .clock_column = {}, .rows = {}};
  guess.because = "row " + std::to_string(names.number) + " has " + std::to_string(day.size()) +
                  " times of a day, from " + csv::in_quotes(names.cells[day.first]) + " to " +
                  csv::in_quotes(names.cells[day.column(day.size() - 1)]);
  guess.rows.assign(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(header));
  KeptRow top{names.number, {}};
  for (const std::size_t other : others) top.cells.push_back(names.cells[other]);
  top.cells.emplace_back("time of day");
  std::string value{kValueColumn};
  if (!day.unit.empty()) value += " (" + day.unit + ")";
  top.cells.push_back(std::move(value));
  guess.rows.push_back(std::move(top));
  for (const KeptRow& row : data) {
    for (std::size_t i = 0; i < day.usual() && guess.rows.size() < kSniffedRows; ++i) {
      KeptRow one{row.number, {}};
      for (const std::size_t other : others) one.cells.push_back(cell_at(row, other));
      one.cells.push_back(clock_words(day.starts_min[i] % 1440));
      one.cells.push_back(cell_at(row, day.column(i)));
      guess.rows.push_back(std::move(one));
    }
  }
  return guess;
}

std::optional<LayoutGuess> guess_row_a_day(std::span<const KeptRow> rows) {
  for (std::size_t i = 0; i + 1 < std::min(rows.size(), kHeaderRowsSeen); ++i) {
    const auto cells = cells_of(rows[i]);
    const auto day = find_day_columns(cells);
    if (!day) continue;
    return day_guess(rows, i, *day);
  }
  return {};
}

/// Rows that are kept, as a source.
class HeadRows final : public RowSource {
 public:
  explicit HeadRows(std::span<const KeptRow> rows) : rows_{rows} {}
  bool next(TableRow& row) override {
    if (at_ == rows_.size()) return false;
    row = {};
    row.number = rows_[at_].number;
    row.cells = cells_of(rows_[at_++]);
    return true;
  }
  [[nodiscard]] const std::optional<Error>& error() const override { return none_; }

 private:
  std::span<const KeptRow> rows_;
  std::size_t at_ = 0;
  std::optional<Error> none_;
};

/// A column a day: turned, it has a row a day.
std::optional<LayoutGuess> guess_column_a_day(std::span<const KeptRow> rows, std::size_t header,
                                              TimeFormat format) {
  for (std::size_t i = 0; i < rows[header].cells.size(); ++i) {
    std::size_t times = 0;
    for (const KeptRow& row : rows.subspan(header + 1)) {
      if (parse_time_of_day(cell_at(row, i))) ++times;
    }
    if (times < 24) continue;
    TableShape shape;
    shape.layout = Layout::column_a_time;
    shape.time_format = format;
    shape.clock_column = rows[header].cells[i];
    if (shape.clock_column.empty()) shape.clock_column = "#" + std::to_string(i + 1);
    const auto turned = turned_rows(std::make_unique<HeadRows>(rows.subspan(header)), shape);
    std::vector<KeptRow> by_day;
    for (TableRow row; turned->next(row);) {
      by_day.push_back({row.number, {row.cells.begin(), row.cells.end()}});
    }
    auto guess = guess_row_a_day(by_day);
    if (!guess) continue;
    guess->layout = Layout::column_a_time;
    guess->clock_column = shape.clock_column;
    guess->because = "row " + std::to_string(rows[header].number) + " has days, and column " +
                     csv::in_quotes(shape.clock_column) + " the times of a day";
    guess->rows.insert(guess->rows.begin(), rows.begin(),
                       rows.begin() + static_cast<std::ptrdiff_t>(header));
    return guess;
  }
  return {};
}

std::optional<LayoutGuess> time_guess(std::span<const KeptRow> rows, std::size_t header,
                                      const TimeColumns& times) {
  const auto data = rows.subspan(header + 1);
  const KeptRow& names = rows[header];
  const auto others = telling_columns(data, names.cells.size(), [&](std::size_t i) {
    return std::ranges::binary_search(times.places, i);
  });
  LayoutGuess guess{.layout = Layout::column_a_time, .because = {}, .clock_column = {}, .rows = {}};
  guess.because = "row " + std::to_string(names.number) + " has " +
                  std::to_string(times.places.size()) + " times, from " +
                  csv::in_quotes(names.cells[times.places.front()]) + " to " +
                  csv::in_quotes(names.cells[times.places.back()]);
  guess.rows.assign(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(header));
  KeptRow top{names.number, {std::string{kStampColumn}}};
  for (const std::size_t other : others) top.cells.push_back(names.cells[other]);
  top.cells.emplace_back(kValueColumn);
  guess.rows.push_back(std::move(top));
  // Some columns of each row, so that many rows are seen.
  const std::size_t rows_seen = std::max<std::size_t>(1, data.size());
  const std::size_t columns_seen = std::clamp<std::size_t>(kSniffedRows / rows_seen, 24, 400);
  for (const KeptRow& row : data) {
    const std::size_t count = std::min(columns_seen, times.places.size());
    for (std::size_t k = 0; k < count && guess.rows.size() < kSniffedRows; ++k) {
      KeptRow one{row.number, {names.cells[times.places[k]]}};
      for (const std::size_t other : others) one.cells.push_back(cell_at(row, other));
      one.cells.push_back(cell_at(row, times.places[k]));
      guess.rows.push_back(std::move(one));
    }
  }
  return guess;
}

std::optional<LayoutGuess> guess_column_a_time(std::span<const KeptRow> rows) {
  for (std::size_t i = 0; i + 1 < std::min(rows.size(), kHeaderRowsSeen); ++i) {
    const auto cells = cells_of(rows[i]);
    std::optional<TimeColumns> best;
    TimeFormat format{};
    for (const TimeFormat order : kOrders) {
      auto found = find_time_columns(cells, order);
      if (!found || (best && found->places.size() <= best->places.size())) continue;
      best = std::move(found);
      format = order;
    }
    if (!best) continue;
    return best->are_days ? guess_column_a_day(rows, i, format) : time_guess(rows, i, *best);
  }
  return {};
}

}  // namespace

std::optional<LayoutGuess> guess_layout(std::span<const KeptRow> rows) {
  auto guess = guess_row_a_day(rows);
  return guess ? guess : guess_column_a_time(rows);
}

void settle_layout(const LayoutGuess& layout, TableGuess& guess) {
  TableShape& shape = guess.shape;
  shape.layout = layout.layout;
  shape.clock_column = layout.clock_column;
  if (layout.layout == Layout::column_a_time) shape.time_column = kStampColumn;
  GuessedColumn value{"", std::string{kValueColumn}, ""};
  for (const GuessedColumn& one : guess.values) {
    if (one.column.starts_with(kValueColumn)) value.unit = one.unit;
  }
  guess.values = {std::move(value)};
  std::erase_if(guess.ignored,
                [](const std::string& text) { return text.starts_with("time of day"); });
}

}  // namespace recald::table
