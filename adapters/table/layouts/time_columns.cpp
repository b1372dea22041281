#include "adapters/table/layouts/time_columns.hpp"

#include <algorithm>

#include "adapters/table/cells/stamps.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/layouts/kept_table.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

using metering::Instant;

class TimeRows final : public RowSource {
 public:
  TimeRows(std::unique_ptr<RowSource> table, const TableShape& shape)
      : table_{std::move(table)}, shape_{shape} {}

  bool next(TableRow& row) override { return columns_ ? next_of_times(row) : next_above(row); }

  [[nodiscard]] const std::optional<Error>& error() const override {
    return error_ ? error_ : table_->error();
  }

 private:
  bool next_above(TableRow& row) {
    if (error_) return false;
    if (!table_->next(row)) {
      error_.emplace(ErrorCode::malformed,
                     "no row has times written as " + std::string{to_string(shape_.time_format)} +
                         " in most of its cells, as layout = \"column_a_time\" has it");
      return false;
    }
    columns_ = find_time_columns(row.cells, shape_.time_format);
    if (!columns_) return true;
    header_ = KeptTableRow{row};
    names_ = {std::string{kStampColumn}, std::string{kValueColumn}};
    for (std::size_t i = 0, k = 0; i < header_.cells.size(); ++i) {
      if (k < columns_->places.size() && columns_->places[k] == i) {
        ++k;
        continue;
      }
      others_.push_back(i);
      names_.push_back(utf8_of(header_.cells[i]));
    }
    place_ = columns_->places.size();
    row.cells.assign(names_.begin(), names_.end());
    return true;
  }

  void hand_out(const KeptTableRow& from, std::size_t place, std::string_view stamp,
                TableRow& row) const {
    row.number = from.number;
    row.text = from.text.empty() ? std::string_view{from.cells.front()} : from.text;
    row.problem = {};
    row.is_terminated = true;
    row.cells.clear();
    row.cells.push_back(stamp);
    row.cells.push_back(from.cell(columns_->places[place]));
    for (const std::size_t other : others_) row.cells.push_back(from.cell(other));
  }

  bool next_of_times(TableRow& row) {
    while (place_ == columns_->places.size()) {
      TableRow next;
      if (!table_->next(next)) return false;
      row_ = KeptTableRow{next};
      if (!row_.problem.empty()) return hand_out_problem(row_, row);
      if (!row_.is_empty()) place_ = 0;
    }
    hand_out(row_, place_, header_.cell(columns_->places[place_]), row);
    const bool is_last = columns_->places[place_] + 1 == row_.cells.size();
    row.is_terminated = row_.is_terminated || !is_last;
    ++place_;
    return true;
  }

  /// A line that could not be split into cells.
  static bool hand_out_problem(const KeptTableRow& from, TableRow& row) {
    row.number = from.number;
    row.text = from.text;
    row.problem = from.problem;
    row.is_terminated = true;
    row.cells.clear();
    return true;
  }

  std::unique_ptr<RowSource> table_;
  TableShape shape_;
  std::optional<TimeColumns> columns_;
  KeptTableRow header_;
  std::vector<std::string> names_;
  std::vector<std::size_t> others_;
  KeptTableRow row_;
  std::size_t place_ = 0;  ///< Of the next cell, in the list of places.
  std::optional<Error> error_;
};

}  // namespace

std::optional<TimeColumns> find_time_columns(std::span<const std::string_view> header,
                                             TimeFormat format) {
  if (header.size() < kTimeColumnsMin) return {};
  TimeColumns found;
  std::size_t with_time = 0;
  std::size_t filled = 0;
  std::ptrdiff_t rises = 0;
  std::optional<Instant> last;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (!header[i].empty()) ++filled;
    if (header[i].size() < 6) continue;
    const auto written = parse_stamp(header[i], format);
    if (!written) continue;
    found.places.push_back(i);
    if (written->has_time) ++with_time;
    const Instant now = written->clock - written->utc_offset.value_or(std::chrono::seconds{0});
    if (last) rises += now > *last ? 1 : now < *last ? -1 : 0;
    last = now;
  }
  const std::size_t count = found.places.size();
  if (count < kTimeColumnsMin || 2 * count < filled) return {};
  const auto steps = static_cast<std::ptrdiff_t>(count) - 1;
  if (10 * std::abs(rises) < 8 * steps) return {};
  found.are_days = with_time == 0;
  return found;
}

std::unique_ptr<RowSource> time_rows(std::unique_ptr<RowSource> table, const TableShape& shape) {
  return std::make_unique<TimeRows>(std::move(table), shape);
}

}  // namespace recald::table
