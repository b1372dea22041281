#include "adapters/table/files/open_rows.hpp"

#include <algorithm>
#include <string>

#include "adapters/csv/fields.hpp"
#include "adapters/table/containers/influx_csv.hpp"
#include "adapters/table/containers/json_rows.hpp"
#include "adapters/table/containers/nem12.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/green_button.hpp"
#include "adapters/table/layouts/layout_rows.hpp"
#include "adapters/table/xlsx.hpp"
#include "core/text/utf8.hpp"

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

/// The rows as the file has them.
Result<std::unique_ptr<RowSource>> open_container(const std::filesystem::path& file,
                                                  const TableShape& shape) {
  const auto open = [&file] { return csv::open_file(file, "export"); };
  // Times that run across a table make it as wide as others are long.
  const bool is_wide = shape.layout == Layout::column_a_time;
  switch (shape.container) {
    case Container::xlsx:
      return open_sheet(file, shape.sheet);
    case Container::green_button:
      return open_green_button(file);
    case Container::json: {
      auto rows = json_rows(open);
      if (rows) return rows;
      return failure(rows.error().code,
                     csv::in_quotes(file.string()) + ": " + rows.error().message);
    }
    case Container::nem12: {
      auto bytes = TRY(open());
      return nem12_rows(std::move(bytes));
    }
    case Container::influx: {
      auto bytes = TRY(open());
      return influx_rows(std::move(bytes));
    }
    case Container::text:
      break;
  }
  char separator = shape.separator;
  if (separator == '\0') {
    separator = TRY(separator_of(file, is_wide ? shape.meter_column : shape.time_column));
  }
  auto bytes = TRY(open());
  return delimited_rows(std::move(bytes), separator, is_wide ? kWideRows : RowLimits{});
}

}  // namespace

Result<std::unique_ptr<RowSource>> open_rows(const std::filesystem::path& file,
                                             const TableShape& shape,
                                             const metering::LocalCalendar* calendar) {
  auto rows = TRY(open_container(file, shape));
  return layout_rows(std::move(rows), shape, calendar);
}

Result<void> read_table(const std::filesystem::path& file, const TableShape& shape,
                        std::span<const TableMeter> meters, const metering::LocalCalendar& calendar,
                        csv::ReadingIntake& intake, ClockFacts* facts) {
  std::optional<metering::LocalCalendar> own;
  if (!shape.timezone.empty()) own = TRY(metering::LocalCalendar::open(shape.timezone));
  auto rows = TRY(open_rows(file, shape, own ? &*own : &calendar));
  TRY(read_table(*rows, file.string(), shape_of_rows(shape), meters, calendar, intake, facts));
  if (facts != nullptr) facts->notes = rows->notes();
  return {};
}

}  // namespace recald::table
