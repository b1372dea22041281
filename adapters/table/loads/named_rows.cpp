#include "adapters/table/loads/named_rows.hpp"

#include <algorithm>
#include <string>

#include "adapters/table/cells/stamps.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/read_table.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

std::vector<std::string> texts_of(const TableRow& row) {
  std::vector<std::string> texts;
  for (const std::string_view cell : row.cells) texts.push_back(utf8_of(cell));
  return texts;
}

class JoinedNames final : public RowSource {
 public:
  JoinedNames(std::unique_ptr<RowSource> rows, const TableShape& shape)
      : rows_{std::move(rows)}, columns_{shape.further_meter_columns} {
    columns_.insert(columns_.begin(), shape.meter_column);
    is_below_header_ = find_places({});
  }

  bool next(TableRow& row) override {
    if (!rows_->next(row)) return false;
    if (!is_below_header_) {
      header_ = texts_of(row);
      is_below_header_ = find_places(header_);
      return true;
    }
    const std::size_t first = places_.front();
    if (first >= row.cells.size()) return true;
    if (first < header_.size() && row.cells[first] == header_[first]) {
      (void)find_places(texts_of(row));  // the header of another block
      return true;
    }
    joined_.clear();
    for (const std::size_t place : places_) {
      const std::string_view text = place < row.cells.size() ? row.cells[place] : "";
      if (text.empty()) continue;
      if (!joined_.empty()) joined_ += kNamesApart;
      joined_ += text;
    }
    row.cells[first] = joined_;
    return true;
  }

  [[nodiscard]] const std::optional<Error>& error() const override { return rows_->error(); }

 private:
  [[nodiscard]] std::vector<std::string> said() const override { return rows_->notes(); }

  bool find_places(const std::vector<std::string>& header) {
    std::vector<std::size_t> places;
    for (const std::string& column : columns_) {
      const auto place = find_column(header, column);
      if (!place) return false;
      places.push_back(*place);
    }
    places_ = std::move(places);
    return true;
  }

  std::unique_ptr<RowSource> rows_;
  std::vector<std::string> columns_;
  std::vector<std::string> header_;
  std::vector<std::size_t> places_;
  bool is_below_header_ = false;
  std::string joined_;
};

class TitledRows final : public RowSource {
 public:
  TitledRows(std::unique_ptr<RowSource> rows, const TableShape& shape)
      : rows_{std::move(rows)}, shape_{shape} {}

  bool next(TableRow& row) override {
    while (rows_->next(row)) {
      if (is_header(row)) {
        title_ = above_;
        width_ = row.cells.size();
        row.cells.push_back(kTitleColumn);
        return true;
      }
      if (is_title(row)) continue;
      if (row.problem.empty()) row.cells.resize(width_);
      row.cells.push_back(title_);
      return true;
    }
    return false;
  }

  [[nodiscard]] const std::optional<Error>& error() const override { return rows_->error(); }

 private:
  [[nodiscard]] std::vector<std::string> said() const override { return rows_->notes(); }

  bool is_header(const TableRow& row) {
    const bool has_name = std::ranges::any_of(row.cells, [&](std::string_view cell) {
      return !cell.empty() && utf8_of(cell) == shape_.time_column;
    });
    if (!has_name) return false;
    const auto time = find_time_in_header(texts_of(row), shape_);
    if (time) time_ = *time;
    return time.has_value();
  }

  bool is_title(const TableRow& row) {
    const auto filled = std::count_if(row.cells.begin(), row.cells.end(),
                                      [](std::string_view cell) { return !cell.empty(); });
    if (filled < 1 || filled > 2 || !row.problem.empty()) return false;
    const std::string_view time = time_ < row.cells.size() ? row.cells[time_] : "";
    if (parse_stamp(time, shape_.time_format)) return false;
    above_.clear();
    for (const std::string_view cell : row.cells) {
      if (cell.empty()) continue;
      if (!above_.empty()) above_ += ' ';
      above_ += utf8_of(cell);
    }
    return true;
  }

  std::unique_ptr<RowSource> rows_;
  TableShape shape_;
  std::size_t time_ = 0;
  std::size_t width_ = 0;  ///< Cells of the block's header.
  std::string above_;      ///< The latest line that may be a title.
  std::string title_;
};

}  // namespace

std::unique_ptr<RowSource> joined_names(std::unique_ptr<RowSource> rows, const TableShape& shape) {
  return std::make_unique<JoinedNames>(std::move(rows), shape);
}

std::unique_ptr<RowSource> titled_rows(std::unique_ptr<RowSource> rows, const TableShape& shape) {
  return std::make_unique<TitledRows>(std::move(rows), shape);
}

}  // namespace recald::table
