#include "adapters/doe/table_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text/nearest.hpp"

namespace recald::doe {

Result<TableReader> TableReader::open(const std::filesystem::path& file) {
  auto source = TRY(csv::open_file(file, "file"));
  TableReader table{file, std::move(source)};
  TRY(table.read_header());
  return table;
}

tl::unexpected<Error> TableReader::wrong_header(const std::string& sentence) const {
  return failure(ErrorCode::malformed, fmt::format("'{}': {}", file_.string(), sentence));
}

tl::unexpected<Error> TableReader::wrong(const std::string& sentence) const {
  return failure(ErrorCode::malformed, fmt::format("'{}':{}: {}", file_.string(), line_, sentence));
}

Result<bool> TableReader::next_line(csv::Line& line) {
  while (lines_.next(line)) {
    line_ = line.number;
    if (line.too_long) return wrong("the line is longer than 64 KiB");
    if (line.text.empty() || line.text.front() == '#') continue;
    ends_open_ = !line.terminated;
    return true;
  }
  if (lines_.error()) return tl::unexpected(*lines_.error());
  return false;
}

Result<void> TableReader::read_header() {
  csv::Line line{};
  const auto found = TRY(next_line(line));
  if (!found) return wrong_header("the file is empty; its first line has to name the columns");
  if (line.text.find(';') != std::string_view::npos) {
    return wrong_header("separate columns by commas, not semicolons");
  }
  const std::size_t count = fields_.split(line.text);
  if (count == 0) return wrong_header("a quote in the header is not closed");
  if (count > csv::FieldSplitter::kFieldsMax) {
    return failure(ErrorCode::unsupported,
                   fmt::format("'{}' has more than {} columns; remove those that are not needed",
                               file_.string(), csv::FieldSplitter::kFieldsMax));
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::string column{text(i)};
    if (column.empty()) return wrong_header(fmt::format("column {} has no name", i + 1));
    if (find(column)) return wrong_header(fmt::format("column '{}' comes twice", column));
    columns_.push_back(std::move(column));
  }
  return {};
}

std::optional<std::size_t> TableReader::find(std::string_view column) const {
  const auto found = std::ranges::find(columns_, column);
  if (found == columns_.end()) return {};
  return static_cast<std::size_t>(found - columns_.begin());
}

Result<std::size_t> TableReader::require(std::string_view column) const {
  if (const auto found = find(column)) return *found;
  const std::vector<std::string_view> names{columns_.begin(), columns_.end()};
  const std::string_view nearest = nearest_name(column, names);
  return wrong_header(fmt::format("column '{}' is missing{}; the file has {}", column,
                                  nearest.empty() ? "" : fmt::format(" (is it '{}'?)", nearest),
                                  listed(columns_)));
}

Result<bool> TableReader::next() {
  csv::Line line{};
  const auto found = next_line(line);
  if (!found || !*found) return found;
  const std::size_t count = fields_.split(line.text);
  if (count == columns_.size()) return true;
  if (count == 0) return wrong("a quote is not closed");
  return wrong(fmt::format("{} fields instead of {}; each row needs one field a column", count,
                           columns_.size()));
}

Result<double> TableReader::number(std::size_t column) const {
  const std::string_view field = text(column);
  if (const auto value = csv::parse_number(field)) return *value;
  if (field.empty()) return wrong(fmt::format("column '{}' is blank", columns_[column]));
  return wrong(fmt::format("column '{}' is '{}'; write a number with a dot, such as 12.5",
                           columns_[column], field));
}

Result<std::optional<double>> TableReader::number_or_blank(std::size_t column) const {
  if (text(column).empty()) return std::optional<double>{};
  return number(column).map([](double value) { return std::optional{value}; });
}

Result<int> TableReader::whole_number(std::size_t column) const {
  const auto value = TRY(number(column));
  if (value >= 0.0 && value <= 999'999'999.0 && value == std::floor(value)) {
    return static_cast<int>(value);
  }
  return wrong(fmt::format("column '{}' is '{}'; write a whole number, such as 17",
                           columns_[column], text(column)));
}

std::string listed(std::span<const std::string> names) {
  constexpr std::size_t most = 8;
  if (names.empty()) return "none";
  if (names.size() == 1) return names.front();
  const std::size_t shown = std::min(names.size() - 1, most);
  std::string text = fmt::format("{}", fmt::join(names.first(shown), ", "));
  const std::size_t rest = names.size() - shown;
  return text + (rest == 1 ? " and " + names.back() : fmt::format(" and {} more", rest));
}

}  // namespace recald::doe
