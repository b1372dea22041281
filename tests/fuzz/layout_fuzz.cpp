// Whatever a text is, each container and each layout reads it to its end: rows have numbers, what
// cannot be read has a sentence, and readings are on their grid, finite or blank.
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "adapters/table/containers/influx_csv.hpp"
#include "adapters/table/containers/json_rows.hpp"
#include "adapters/table/containers/nem12.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/layouts/guess_layout.hpp"
#include "adapters/table/layouts/layout_rows.hpp"
#include "adapters/table/loads/meter_parts.hpp"
#include "adapters/table/loads/rows_apart.hpp"
#include "adapters/table/read_table.hpp"
#include "core/text/utf8.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

using Rows = std::unique_ptr<table::RowSource>;

void require_rows(table::RowSource& rows) {
  for (table::TableRow row; rows.next(row);) {
    require(row.cells.size() <= table::kWideRows.cells, "a row has a limit");
    if (!row.problem.empty()) require_sentence(row.problem);
  }
  if (rows.error()) require_sentence(rows.error()->message);
  for (const std::string& note : rows.notes()) require_sentence(note);
}

void require_readings(Rows rows, const table::TableShape& shape,
                      const metering::LocalCalendar& calendar) {
  const std::vector<table::TableMeter> meters{{.rows = {.name = "a"},
                                               .column = "value",
                                               .unit = "kWh",
                                               .further_names = {"b"},
                                               .further_columns = {}}};
  const csv::ReadingsSink sink{.on_meter = {}, .on_reading = [](const metering::Reading& reading) {
                                 require(!std::isinf(reading.mean_kW), "finite or blank");
                               }};
  table::MeterParts parts{meters};
  const csv::ReadingsSink of_parts = parts.sink(sink);
  csv::ReadingIntake intake{table::intake_options(parts.parts()), of_parts};
  const auto all = table::layout_rows(std::move(rows), shape, &calendar);
  const auto read = table::read_table(*all, "export.csv", table::shape_of_rows(shape),
                                      parts.parts(), calendar, intake, nullptr);
  if (!read) return require_sentence(read.error().message);
  const auto report = parts.finish(intake.finish());
  if (!report) require_sentence(report.error().message);
}

void require_layouts(const std::function<Rows()>& open, const metering::LocalCalendar& calendar) {
  std::vector<table::KeptRow> head;
  const Rows first = open();
  for (table::TableRow row; head.size() < 200 && first->next(row);) {
    head.push_back({row.number, {}});
    for (const std::string_view cell : row.cells) {
      head.back().cells.push_back(utf8_of(cell));
    }
  }
  if (const auto layout = table::guess_layout(head)) {
    auto guess = table::guess_table(layout->rows);
    if (guess) {
      table::settle_layout(*layout, *guess);
      require_readings(open(), guess->shape, calendar);
    }
  }
  const auto guess = table::guess_table(head);
  if (!guess) return;
  table::TableShape titled = guess->shape;
  titled.meter_column = table::kTitleColumn;
  const auto apart = table::columns_that_tell_apart(
      [&]() -> Result<Rows> { return table::layout_rows(open(), titled, &calendar); }, titled, {});
  require(apart.has_value(), "rows from memory do not fail");
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald;
  static const auto calendar = metering::LocalCalendar::open("Europe/Berlin");
  const std::string_view text = fuzz::text_of(data, size);
  fuzz::require_rows(*table::nem12_rows(csv::bytes_of(text)));
  fuzz::require_rows(*table::influx_rows(csv::bytes_of(text)));
  const auto json =
      table::json_rows([&]() -> Result<csv::ByteSource> { return csv::bytes_of(text); });
  if (json) {
    fuzz::require_rows(**json);
  } else {
    fuzz::require_sentence(json.error().message);
  }
  for (const char separator : {',', ';'}) {
    fuzz::require_layouts(
        [&] { return table::delimited_rows(csv::bytes_of(text), separator, table::kWideRows); },
        *calendar);
  }
  return 0;
}
