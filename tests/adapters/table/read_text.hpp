/// Reads a table from memory in any layout.
#pragma once

#include <string_view>
#include <vector>

#include "adapters/table/delimited.hpp"
#include "adapters/table/layouts/layout_rows.hpp"
#include "adapters/table/loads/meter_parts.hpp"
#include "adapters/table/read_table.hpp"
#include "adapters/table/sniff.hpp"

namespace recald::table::testing {

struct ReadText {
  Result<csv::ReadingsReport> report = csv::ReadingsReport{};
  std::vector<metering::Reading> readings;
  ClockFacts clock;
  std::vector<std::string> notes;

  /// kWh of a meter.
  [[nodiscard]] double energy(std::uint32_t meter = 0) const {
    double sum_kWh = 0.0;
    for (const metering::Reading& reading : readings) {
      if (reading.meter != meter || reading.mean_kW != reading.mean_kW) continue;
      sum_kWh += reading.mean_kW * metering::in_hours(report->meters[meter].shown.interval);
    }
    return sum_kWh;
  }
};

/// As `open_rows` and `read_table` read a file.
inline ReadText read_rows(std::unique_ptr<RowSource> rows, const TableShape& shape,
                          const std::vector<TableMeter>& meters,
                          const metering::LocalCalendar& calendar) {
  ReadText read;
  const csv::ReadingsSink sink{.on_meter = {}, .on_reading = [&](const metering::Reading& reading) {
                                 read.readings.push_back(reading);
                               }};
  MeterParts parts{meters};
  const csv::ReadingsSink of_parts = parts.sink(sink);
  csv::ReadingIntake intake{intake_options(parts.parts()), of_parts};
  const auto all = layout_rows(std::move(rows), shape, &calendar);
  const auto done = read_table(*all, "export.csv", shape_of_rows(shape), parts.parts(), calendar,
                               intake, &read.clock);
  if (!done) {
    read.report = tl::unexpected(done.error());
  } else {
    read.report = parts.finish(intake.finish());
  }
  read.notes = all->notes();
  return read;
}

inline ReadText read_text_as(std::string_view text, const TableShape& shape,
                             const std::vector<TableMeter>& meters,
                             const metering::LocalCalendar& calendar) {
  return read_rows(delimited_rows(csv::bytes_of(text), shape.separator, kWideRows), shape, meters,
                   calendar);
}

inline std::vector<KeptRow> kept_rows(RowSource& rows, std::size_t most = 2000) {
  std::vector<KeptRow> kept;
  for (TableRow row; kept.size() < most && rows.next(row);) {
    kept.push_back({row.number, {row.cells.begin(), row.cells.end()}});
  }
  return kept;
}

}  // namespace recald::table::testing
