#include <algorithm>
#include <string>

#include "adapters/csv/fields.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/green_button.hpp"
#include "adapters/table/read_table.hpp"
#include "adapters/table/xlsx.hpp"

namespace recald::table {
namespace {

constexpr std::uint64_t kSearchedLines = 200;

/// The separator of the line with the time column, or else of the first line that is not blank.
Result<char> separator_of(const std::filesystem::path& file, std::string_view time_column) {
  auto bytes = TRY(csv::open_file(file, "export"));
  csv::LineReader lines{as_utf8(std::move(bytes))};
  csv::Line line{};
  std::optional<char> first;
  for (std::uint64_t i = 0; i < kSearchedLines && lines.next(line); ++i) {
    if (csv::trimmed(line.text).empty()) continue;
    const char likely = likely_separator(line.text);
    if (!first) first = likely;
    if (utf8_of(line.text).find(time_column) != std::string::npos) return likely;
  }
  return first.value_or(',');
}

}  // namespace

Result<std::unique_ptr<RowSource>> open_rows(const std::filesystem::path& file,
                                             const TableShape& shape) {
  if (shape.container == Container::xlsx) return open_sheet(file, shape.sheet);
  if (shape.container == Container::green_button) return open_green_button(file);
  char separator = shape.separator;
  if (separator == '\0') {
    separator = TRY(separator_of(file, shape.time_column));
  }
  auto bytes = TRY(csv::open_file(file, "export"));
  return delimited_rows(std::move(bytes), separator);
}

Result<void> read_table(const std::filesystem::path& file, const TableShape& shape,
                        std::span<const TableMeter> meters, const metering::LocalCalendar& calendar,
                        csv::ReadingIntake& intake, ClockFacts* facts) {
  auto rows = TRY(open_rows(file, shape));
  return read_table(*rows, file.string(), shape, meters, calendar, intake, facts);
}

}  // namespace recald::table
