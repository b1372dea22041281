#include "adapters/table/layouts/day_rows.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/cell_number.hpp"
#include "adapters/table/cells/stamps.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/layouts/day_columns.hpp"
#include "adapters/table/layouts/kept_table.hpp"
#include "adapters/table/read_table.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

using metering::Day;
using metering::Instant;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr std::size_t kDirectionRows = 64;  // these show whether the newest day comes first
constexpr std::size_t kNotesMax = 20;
constexpr double kTwice = 1.5;  // nearer to two hours' amount than to one's

/// A cell of a day and when its interval starts.
struct PlannedCell {
  std::size_t interval;
  std::string stamp;
  double share = 1.0;  ///< Of the cell's value.
};

std::string clock_text(Instant clock) {
  std::string text = metering::to_string(clock);
  text.pop_back();  // the Z: it is the table's clock
  return text;
}

/// Plans which cells of a day's row are read, and as which time.
class DayPlan {
 public:
  DayPlan(const DayColumns& columns, const TableShape& shape,
          const metering::LocalCalendar* calendar)
      : columns_{columns}, shape_{shape}, calendar_{calendar} {}

  /// @param midnight  Of the day, as its clock shows it.
  void plan(const KeptTableRow& row, Instant midnight, std::vector<PlannedCell>& cells,
            std::string& note) {
    row_ = &row;
    midnight_ = midnight;
    cells.clear();
    note.clear();
    const seconds length = day_length();
    const seconds usual{86'400};
    if (length < usual) return plan_short(length, cells);
    if (length > usual) return plan_long(length, cells, note);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const bool is_extra = columns_.repeats_an_hour ? is_repeat(i) : i >= columns_.usual();
      if (!is_extra || has_amount(i)) add_by_clock(i, cells);
    }
  }

 private:
  [[nodiscard]] seconds step() const { return minutes{columns_.step_min}; }
  [[nodiscard]] Day day() const { return Day{std::chrono::floor<std::chrono::days>(midnight_)}; }
  [[nodiscard]] seconds day_length() const {
    return calendar_ == nullptr ? seconds{86'400} : calendar_->day_span(day()).length();
  }
  [[nodiscard]] std::size_t intervals_in(seconds length) const {
    return std::min(columns_.size(), static_cast<std::size_t>(length / step()));
  }

  [[nodiscard]] std::string_view text(std::size_t i) const {
    return row_->cell(columns_.column(i));
  }
  [[nodiscard]] double value(std::size_t i) const {
    return parse_cell(text(i), shape_.decimal).value_or(std::nan(""));
  }
  [[nodiscard]] bool is_filled(std::size_t i) const { return !is_blank(text(i)); }
  [[nodiscard]] bool has_amount(std::size_t i) const { return is_filled(i) && value(i) != 0.0; }

  /// Whether the column starts when an earlier one does.
  [[nodiscard]] bool is_repeat(std::size_t i) const {
    const auto& starts = columns_.starts_min;
    return std::find(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(i), starts[i]) !=
           starts.begin() + static_cast<std::ptrdiff_t>(i);
  }

  [[nodiscard]] Instant clock_of(std::size_t i) const {
    return midnight_ + minutes{columns_.starts_min[i]};
  }

  void add_by_clock(std::size_t i, std::vector<PlannedCell>& cells) const {
    cells.push_back({i, clock_text(clock_of(i))});
  }

  void add_counted(std::size_t count, std::vector<PlannedCell>& cells) const {
    const Instant begin = calendar_->day_span(day()).begin;
    for (std::size_t i = 0; i < count; ++i) {
      cells.push_back({i, metering::to_string(begin + static_cast<int>(i) * step())});
    }
  }

  /// Columns by what the clock does at their times: `wanted` 0 skips, 2 shows twice.
  [[nodiscard]] std::vector<std::size_t> shown(int wanted) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < std::min(columns_.usual(), columns_.size()); ++i) {
      const Instant clock = clock_of(i);
      const auto occurs = [&](seconds offset) {
        return calendar_->utc_offset(clock - offset) == offset;
      };
      const seconds before = calendar_->utc_offset(clock - seconds{86'400});
      const seconds after = calendar_->utc_offset(clock + seconds{86'400});
      const int times = (occurs(before) ? 1 : 0) + (after != before && occurs(after) ? 1 : 0);
      if (times == wanted) found.push_back(i);
    }
    return found;
  }

  void plan_short(seconds length, std::vector<PlannedCell>& cells) const {
    const std::vector<std::size_t> skipped = shown(0);
    const std::size_t count = intervals_in(length);
    const auto any_skipped = [&](auto is) {
      return std::any_of(skipped.begin(), skipped.end(),
                         [&](std::size_t i) { return (this->*is)(i); });
    };
    const auto any_behind = [&](auto is) {
      for (std::size_t i = count; i < columns_.usual(); ++i) {
        if ((this->*is)(i)) return true;
      }
      return false;
    };
    // A blank says more than a zero: a load may rest.
    for (const auto is : {&DayPlan::is_filled, &DayPlan::has_amount}) {
      const bool in_skipped = any_skipped(is);
      const bool at_end = any_behind(is);
      if (in_skipped && !at_end) return add_counted(count, cells);
      if (in_skipped != at_end) break;
    }
    // Values in the hour that does not exist are passed on: they show that the clock is another.
    const bool is_all_there = any_skipped(&DayPlan::has_amount) && any_behind(&DayPlan::has_amount);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const bool is_skipped = std::find(skipped.begin(), skipped.end(), i) != skipped.end();
      if (is_skipped && !is_all_there) continue;
      if (i >= columns_.usual() && !has_amount(i)) continue;
      if (columns_.repeats_an_hour && is_repeat(i) && !has_amount(i)) continue;
      add_by_clock(i, cells);
    }
  }

  void plan_long(seconds length, std::vector<PlannedCell>& cells, std::string& note) const {
    const std::size_t count = static_cast<std::size_t>(length / step());
    const auto has_extra = [&] {
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        if ((columns_.repeats_an_hour ? is_repeat(i) : i >= columns_.usual()) && is_filled(i)) {
          return true;
        }
      }
      return false;
    };
    if (columns_.size() >= count && has_extra()) return add_counted(count, cells);
    const std::vector<std::size_t> doubled = shown(2);
    const bool is_summed = holds_twice(doubled);
    const seconds first = doubled.empty() ? seconds{0} : before();
    const seconds second = doubled.empty() ? seconds{0} : after();
    bool is_second_pass_done = false;
    for (std::size_t i = 0; i < std::min(columns_.usual(), columns_.size()); ++i) {
      const bool is_doubled = std::find(doubled.begin(), doubled.end(), i) != doubled.end();
      if (!is_doubled) {
        add_by_clock(i, cells);
        continue;
      }
      if (!is_summed) {
        cells.push_back({i, metering::to_string(clock_of(i) - first)});
        continue;
      }
      if (std::exchange(is_second_pass_done, true)) continue;
      for (const seconds offset : {first, second}) {
        for (const std::size_t k : doubled) {
          cells.push_back({k, metering::to_string(clock_of(k) - offset), 0.5});
        }
      }
    }
    if (doubled.empty()) return;
    note = metering::to_string(day()) +
           ": the clock shows an hour twice, and the row has it once; " +
           (is_summed ? "it holds about twice its neighbours, so each of the two gets half"
                      : "it is taken for the first, and the second is missing");
  }

  [[nodiscard]] seconds before() const {
    return calendar_->utc_offset(calendar_->day_span(day()).begin);
  }
  [[nodiscard]] seconds after() const {
    return calendar_->utc_offset(calendar_->day_span(day()).end);
  }

  /// Whether these columns hold about twice what as many before and behind them do.
  [[nodiscard]] bool holds_twice(const std::vector<std::size_t>& doubled) const {
    if (doubled.empty()) return false;
    double inside = 0.0;
    double around = 0.0;
    std::size_t neighbours = 0;
    for (const std::size_t i : doubled) {
      if (std::isfinite(value(i))) inside += value(i) / static_cast<double>(doubled.size());
    }
    for (std::size_t k = 1; k <= doubled.size(); ++k) {
      for (const std::size_t i : {doubled.front() - k, doubled.back() + k}) {
        if (i >= columns_.usual() || !std::isfinite(value(i))) continue;
        around += value(i);
        ++neighbours;
      }
    }
    return neighbours > 0 && inside >= kTwice * around / static_cast<double>(neighbours);
  }

  const DayColumns& columns_;
  const TableShape& shape_;
  const metering::LocalCalendar* calendar_;
  const KeptTableRow* row_ = nullptr;
  Instant midnight_;
};

class DayRows final : public RowSource {
 public:
  DayRows(std::unique_ptr<RowSource> table, const TableShape& shape,
          const metering::LocalCalendar* calendar)
      : table_{std::move(table)}, shape_{shape}, calendar_{calendar} {}

  bool next(TableRow& row) override {
    if (!columns_) return next_above(row);
    for (;;) {
      if (at_ < cells_.size()) {
        hand_out(cells_[at_++], row);
        return true;
      }
      if (!next_day()) return false;
      if (is_plain_) {
        hand_out_plain(row);
        return true;
      }
    }
  }

  [[nodiscard]] const std::optional<Error>& error() const override {
    return error_ ? error_ : table_->error();
  }

 private:
  [[nodiscard]] std::vector<std::string> said() const override { return notes_; }

  /// Rows above the header as they are, then the new header.
  bool next_above(TableRow& row) {
    if (error_) return false;
    if (!table_->next(row)) {
      error_.emplace(ErrorCode::malformed,
                     "no row names the times of a day, such as 00:15, H01 or 1 to 96, in "
                     "neighbouring columns, as layout = \"row_a_day\" has it");
      return false;
    }
    columns_ = find_day_columns(row.cells);
    if (!columns_) return true;
    header_.clear();
    std::vector<std::string> names{std::string{kStampColumn}, std::string{kValueColumn}};
    if (columns_->stride == 2) names.emplace_back(kFlagColumn);
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      header_.push_back(utf8_of(row.cells[i]));
      if (columns_->covers(i)) continue;
      others_.push_back(i);
      names.push_back(header_.back());
    }
    header_cells_ = std::move(names);
    row.cells.assign(header_cells_.begin(), header_cells_.end());
    date_ = find_column(header_, shape_.time_column);
    if (!date_) {
      error_.emplace(ErrorCode::malformed, "beside the times of the day there is no column " +
                                               csv::in_quotes(shape_.time_column) +
                                               ", which should have the dates");
      return false;
    }
    plan_.emplace(*columns_, shape_, calendar_);
    find_direction();
    return true;
  }

  [[nodiscard]] std::optional<Instant> midnight_of(const KeptTableRow& row) const {
    if (!date_) return {};
    const auto written = parse_stamp(row.cell(*date_), shape_.time_format);
    if (!written) return {};
    return std::chrono::floor<std::chrono::days>(written->clock);
  }

  /// Looks at the first rows; a table that begins with the newest day is kept to its end.
  void find_direction() {
    KeptTableRow row;
    const auto keep_next = [&] {
      TableRow next;
      if (!table_->next(next)) return false;
      kept_.push_back(KeptTableRow{next});
      return true;
    };
    while (kept_.size() < kDirectionRows && keep_next()) {
    }
    std::optional<Instant> last;
    int rises = 0;
    for (const KeptTableRow& one : kept_) {
      const auto midnight = midnight_of(one);
      if (!midnight) continue;
      if (last && *midnight != *last) rises += *midnight > *last ? 1 : -1;
      last = midnight;
    }
    if (rises >= 0) return;
    while (keep_next()) {
    }
    std::reverse(kept_.begin(), kept_.end());
  }

  bool next_source_row() {
    if (kept_at_ < kept_.size()) {
      row_ = std::move(kept_[kept_at_++]);
      return true;
    }
    TableRow next;
    if (!table_->next(next)) return false;
    row_ = KeptTableRow{next};
    return true;
  }

  /// Plans the next row that has cells. A row without a date is handed out as it is, to be refused.
  bool next_day() {
    at_ = 0;
    cells_.clear();
    while (next_source_row()) {
      is_plain_ = !row_.problem.empty();
      if (is_plain_) return true;
      if (row_.is_empty()) continue;
      if (row_.cells == header_) continue;
      const auto midnight = midnight_of(row_);
      is_plain_ = !midnight;
      if (is_plain_) return true;
      std::string note;
      plan_->plan(row_, *midnight, cells_, note);
      if (!note.empty() && notes_.size() < kNotesMax &&
          std::find(notes_.begin(), notes_.end(), note) == notes_.end()) {
        notes_.push_back(std::move(note));
      }
      settle_last_cell();
      if (!cells_.empty()) return true;
    }
    return false;
  }

  /// Of a row without a line end only the last cell may be cut.
  void settle_last_cell() {
    const std::string_view last = row_.cells.back();
    const auto decimals = [&](std::string_view cell) {
      const std::size_t sign = cell.find(shape_.decimal);
      return sign == std::string_view::npos ? std::size_t{0} : cell.size() - sign - 1;
    };
    const bool is_as_before = row_.cells.size() == width_ && decimals(last) == decimals_;
    is_last_whole_ = row_.is_terminated || (is_as_before && decimals_ > 0);
    width_ = row_.cells.size();
    decimals_ = decimals(last);
  }

  void hand_out_plain(TableRow& row) {
    row.number = row_.number;
    row.problem = row_.problem;
    row.text = row_.text;
    row.is_terminated = row_.is_terminated;
    row.cells.clear();
    if (row_.problem.empty()) row.cells.push_back(date_ ? row_.cell(*date_) : row_.text);
  }

  void hand_out(const PlannedCell& cell, TableRow& row) {
    const std::size_t column = columns_->column(cell.interval);
    const bool is_cut = !is_last_whole_ && column + 1 == row_.cells.size();
    row.number = row_.number;
    row.text = row_.text;
    row.problem = is_cut ? "the last line has no line end, and its last cell may be cut" : "";
    row.is_terminated = true;
    row.cells.clear();
    if (is_cut) return;
    row.cells.push_back(cell.stamp);
    row.cells.push_back(cell.share == 1.0 ? row_.cell(column)
                                          : share_of(row_.cell(column), cell.share));
    if (columns_->stride == 2) row.cells.push_back(row_.cell(column + 1));
    for (const std::size_t other : others_) row.cells.push_back(row_.cell(other));
  }

  std::string_view share_of(std::string_view cell, double share) {
    const auto value = parse_cell(cell, shape_.decimal);
    if (!value) return cell;
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), *value * share).ptr;
    share_text_.assign(text.data(), end);
    std::replace(share_text_.begin(), share_text_.end(), '.', shape_.decimal);
    return share_text_;
  }

  std::unique_ptr<RowSource> table_;
  TableShape shape_;
  const metering::LocalCalendar* calendar_;
  std::optional<DayColumns> columns_;
  std::optional<DayPlan> plan_;
  std::vector<std::string> header_;
  std::vector<std::string> header_cells_;
  std::vector<std::size_t> others_;
  std::optional<std::size_t> date_;
  std::vector<KeptTableRow> kept_;
  std::size_t kept_at_ = 0;
  KeptTableRow row_;
  bool is_plain_ = false;
  bool is_last_whole_ = true;
  std::size_t width_ = 0;
  std::size_t decimals_ = 0;
  std::vector<PlannedCell> cells_;
  std::size_t at_ = 0;
  std::string share_text_;
  std::vector<std::string> notes_;
  std::optional<Error> error_;
};

}  // namespace

std::unique_ptr<RowSource> day_rows(std::unique_ptr<RowSource> table, const TableShape& shape,
                                    const metering::LocalCalendar* calendar) {
  return std::make_unique<DayRows>(std::move(table), shape, calendar);
}

}  // namespace recald::table
