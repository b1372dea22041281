#include "adapters/table/containers/influx_csv.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "adapters/csv/fields.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/loads/named_rows.hpp"
#include "adapters/table/sniff.hpp"

namespace recald::table {
namespace {

constexpr std::size_t kNotThere = static_cast<std::size_t>(-1);
constexpr std::array<std::string_view, 6> kNoNames{"",       "result", "table",
                                                   "_start", "_stop",  "_time"};

bool is_numeric_type(std::string_view type) {
  return type == "double" || type == "long" || type == "unsignedLong";
}

bool is_header_row(const std::vector<std::string_view>& cells) {
  return std::ranges::find(cells, "_time") != cells.end();
}

/// One table's columns.
struct FluxColumns {
  std::vector<std::string> header;
  std::vector<std::string> defaults;
  std::vector<std::string> types;
  std::size_t time = kNotThere;
  std::vector<std::size_t> names;
  std::vector<std::size_t> values;  ///< "_value", or the fields of a pivoted table.
};

class InfluxRows final : public RowSource {
 public:
  explicit InfluxRows(csv::ByteSource bytes) : lines_{delimited_rows(std::move(bytes), ',')} {}

  bool next(TableRow& row) override {
    if (!is_header_out_) {
      is_header_out_ = true;
      row = {};
      row.cells = {"timestamp", "meter", "value", "unit"};
      return true;
    }
    while (at_ == columns_.values.size()) {
      if (error_ || !lines_->next(line_)) return false;
      at_ = columns_.values.size();
      if (!line_.problem.empty()) {
        row = line_;
        return true;
      }
      if (take_line()) at_ = 0;
    }
    hand_out(columns_.values[at_++], row);
    return true;
  }

  [[nodiscard]] const std::optional<Error>& error() const override {
    return error_ ? error_ : lines_->error();
  }

 private:
  /// @return whether it has readings.
  bool take_line() {
    const auto& cells = line_.cells;
    const auto texts = [&] { return std::vector<std::string>(cells.begin(), cells.end()); };
    if (std::ranges::all_of(cells, [](std::string_view cell) { return cell.empty(); })) {
      return false;
    }
    const std::string_view first = cells.front();
    if (first.starts_with('#')) {
      is_table_known_ = false;
      if (first == "#datatype") types_ = texts();
      if (first == "#default") defaults_ = texts();
      return false;
    }
    if (is_header_row(cells)) {
      begin_table(texts());
      return false;
    }
    if (std::ranges::find(cells, "error") != cells.end() &&
        std::ranges::find(cells, "reference") != cells.end()) {
      error_.emplace(ErrorCode::malformed, "it is the answer to a query that failed");
      return false;
    }
    return is_table_known_ && cells.size() > columns_.time;
  }

  void begin_table(std::vector<std::string> header) {
    columns_ = {.header = std::move(header), .defaults = defaults_, .types = types_};
    is_table_known_ = true;
    const auto value = std::ranges::find(columns_.header, "_value");
    for (std::size_t i = 0; i < columns_.header.size(); ++i) {
      const std::string& name = columns_.header[i];
      if (name == "_time") columns_.time = i;
      if (std::ranges::find(kNoNames, name) != kNoNames.end() || name == "_value") continue;
      const bool is_field = value == columns_.header.end() && i < columns_.types.size() &&
                            is_numeric_type(columns_.types[i]);
      (is_field ? columns_.values : columns_.names).push_back(i);
    }
    if (value != columns_.header.end()) {
      columns_.values = {static_cast<std::size_t>(value - columns_.header.begin())};
    }
    at_ = columns_.values.size();
    series_.clear();
  }

  [[nodiscard]] std::string_view cell(std::size_t column) const {
    if (column < line_.cells.size() && !line_.cells[column].empty()) return line_.cells[column];
    return column < columns_.defaults.size() ? std::string_view{columns_.defaults[column]}
                                             : std::string_view{};
  }

  /// Rows of a series stand below each other, so its name is made once.
  void name_series(std::size_t value) {
    key_.clear();
    for (const std::size_t column : columns_.names) {
      key_ += cell(column);
      key_ += '\x1f';
    }
    key_ += std::to_string(value);
    if (key_ == series_) return;
    series_ = key_;
    meter_.clear();
    unit_.clear();
    const auto add = [&](std::string_view text) {
      if (text.empty()) return;
      if (!meter_.empty()) meter_ += kNamesApart;
      meter_ += text;
      std::string apart{text};
      std::ranges::replace(apart, '_', ' ');
      if (unit_.empty()) unit_ = split_unit(apart).unit;
    };
    for (const std::size_t column : columns_.names) add(cell(column));
    if (columns_.header[value] != "_value") add(columns_.header[value]);
    if (meter_.empty()) meter_ = "_value";
  }

  void hand_out(std::size_t value, TableRow& row) {
    name_series(value);
    row.number = line_.number;
    row.text = line_.text;
    row.problem = {};
    row.is_terminated = line_.is_terminated;
    row.cells = {cell(columns_.time), meter_, cell(value), unit_};
  }

  std::unique_ptr<RowSource> lines_;
  TableRow line_;
  bool is_header_out_ = false;
  bool is_table_known_ = false;
  std::vector<std::string> types_;
  std::vector<std::string> defaults_;
  FluxColumns columns_;
  std::size_t at_ = 0;
  std::string key_;
  std::string series_;
  std::string meter_;
  std::string unit_;
  std::optional<Error> error_;
};

}  // namespace

bool is_influx_csv(std::span<const std::string> first_lines) {
  for (const std::string& line : first_lines) {
    if (line.starts_with("#datatype,") || line.starts_with("#group,")) return true;
    if (csv::trimmed(line).empty() || line.starts_with('#')) continue;
    return line.find(",_time") != std::string::npos && line.find(",result") != std::string::npos;
  }
  return false;
}

std::unique_ptr<RowSource> influx_rows(csv::ByteSource bytes) {
  return std::make_unique<InfluxRows>(std::move(bytes));
}

}  // namespace recald::table
