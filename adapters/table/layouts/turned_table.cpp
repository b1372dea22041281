#include "adapters/table/layouts/turned_table.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "adapters/csv/fields.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/layouts/kept_table.hpp"
#include "adapters/table/layouts/time_columns.hpp"
#include "adapters/table/read_table.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

constexpr std::size_t kTurnedCellsMax = 4'000'000;

class TurnedRows final : public RowSource {
 public:
  TurnedRows(std::unique_ptr<RowSource> table, const TableShape& shape)
      : table_{std::move(table)}, shape_{shape} {}

  bool next(TableRow& row) override {
    if (!is_kept_ && !keep_all()) return false;
    if (!is_header_out_) return hand_out_header(row);
    if (block_ == blocks_.size()) return false;
    hand_out_day(blocks_[block_], columns_->places[day_], row);
    if (++day_ == columns_->places.size()) {
      day_ = 0;
      ++block_;
    }
    return true;
  }

  [[nodiscard]] const std::optional<Error>& error() const override {
    return error_ ? error_ : table_->error();
  }

 private:
  /// The rows of one meter: a time of the day each.
  struct Block {
    std::vector<std::string> others;
    std::vector<KeptTableRow> rows;
  };

  bool fail(std::string_view sentence) {
    error_.emplace(ErrorCode::malformed, sentence);
    return false;
  }

  bool keep_all() {
    is_kept_ = true;
    if (!find_header()) return false;
    std::map<std::vector<std::string>, std::size_t> known;
    std::size_t cells = 0;
    for (TableRow next; table_->next(next);) {
      KeptTableRow row{next};
      if (row.cell(*clock_).empty()) continue;  // a row of totals, or of units
      cells += row.cells.size();
      if (cells > kTurnedCellsMax) {
        return fail(
            "a table with a column a day has more than four million cells; export fewer "
            "days at once");
      }
      std::vector<std::string> others;
      for (const std::size_t other : others_) others.emplace_back(row.cell(other));
      const auto [place, is_new] = known.try_emplace(others, blocks_.size());
      if (is_new) blocks_.push_back({std::move(others), {}});
      blocks_[place->second].rows.push_back(std::move(row));
    }
    if (table_->error()) return false;
    return require_same_times();
  }

  bool find_header() {
    for (TableRow next; !columns_;) {
      if (!table_->next(next)) {
        return fail("no row has dates written as " + std::string{to_string(shape_.time_format)} +
                    " in most of its cells, as layout = \"column_a_time\" has it");
      }
      columns_ = find_time_columns(next.cells, shape_.time_format);
      if (columns_) header_ = KeptTableRow{next};
    }
    std::vector<std::string> names;
    for (const std::string& cell : header_.cells) names.push_back(utf8_of(cell));
    clock_ = find_column(names, shape_.clock_column);
    if (!clock_) {
      return fail("its columns are days, but it has no column " +
                  csv::in_quotes(shape_.clock_column) +
                  " with the times of the day; name it as 'clock_column'");
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (i == *clock_ || std::ranges::binary_search(columns_->places, i)) continue;
      others_.push_back(i);
      other_names_.push_back(names[i]);
    }
    return true;
  }

  bool require_same_times() {
    for (const Block& block : blocks_) {
      const Block& first = blocks_.front();
      const bool is_same = std::ranges::equal(block.rows, first.rows,
                                              [&](const KeptTableRow& a, const KeptTableRow& b) {
                                                return a.cell(*clock_) == b.cell(*clock_);
                                              });
      if (is_same) continue;
      return fail("its meters do not have the same times of the day; row " +
                  std::to_string(block.rows.front().number) + " begins another list of them");
    }
    return true;
  }

  bool hand_out_header(TableRow& row) {
    is_header_out_ = true;
    row = {};
    row.number = header_.number;
    row.text = header_.text;
    row.cells = {kDateColumn};
    row.cells.insert(row.cells.end(), other_names_.begin(), other_names_.end());
    if (blocks_.empty()) return true;
    for (const KeptTableRow& one : blocks_.front().rows) row.cells.push_back(one.cell(*clock_));
    return true;
  }

  void hand_out_day(const Block& block, std::size_t place, TableRow& row) const {
    row.number = block.rows.front().number;
    row.text = header_.cell(place);
    row.problem = {};
    row.is_terminated = true;
    row.cells.clear();
    row.cells.push_back(header_.cell(place));
    row.cells.insert(row.cells.end(), block.others.begin(), block.others.end());
    for (const KeptTableRow& one : block.rows) row.cells.push_back(one.cell(place));
  }

  std::unique_ptr<RowSource> table_;
  TableShape shape_;
  std::optional<TimeColumns> columns_;
  KeptTableRow header_;
  std::optional<std::size_t> clock_;
  std::vector<std::size_t> others_;
  std::vector<std::string> other_names_;
  std::vector<Block> blocks_;
  bool is_kept_ = false;
  bool is_header_out_ = false;
  std::size_t block_ = 0;
  std::size_t day_ = 0;
  std::optional<Error> error_;
};

}  // namespace

std::unique_ptr<RowSource> turned_rows(std::unique_ptr<RowSource> table, const TableShape& shape) {
  return std::make_unique<TurnedRows>(std::move(table), shape);
}

}  // namespace recald::table
