// A table that is understood is read the way it was: readings are on their grid, finite or blank.
// What is not understood, and every row that is kept out, has its reason.
#include <cmath>
#include <vector>

#include "adapters/table/delimited.hpp"
#include "adapters/table/read_table.hpp"
#include "adapters/table/sniff.hpp"
#include "core/text/utf8.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

std::vector<table::KeptRow> rows_of(std::string_view text, char separator) {
  const auto rows = table::delimited_rows(csv::bytes_of(text), separator);
  std::vector<table::KeptRow> kept;
  for (table::TableRow row; kept.size() < 200 && rows->next(row);) {
    kept.push_back({row.number, {}});
    for (const std::string_view cell : row.cells) {
      kept.back().cells.push_back(utf8_of(cell));
    }
  }
  return kept;
}

void require_read(std::string_view text, const table::TableGuess& guess,
                  const metering::LocalCalendar& calendar) {
  std::vector<table::TableMeter> meters;
  for (const table::GuessedColumn& value : guess.values) {
    require(!value.column.empty(), "a column has a name");
    meters.push_back({.rows = {.name = value.name},
                      .column = value.column,
                      .unit = guess.shape.unit_column.empty() ? "kWh" : ""});
  }
  std::vector<metering::Reading> readings;
  const csv::ReadingsSink sink{.on_meter = {}, .on_reading = [&](const metering::Reading& reading) {
                                 readings.push_back(reading);
                               }};
  const auto rows = table::delimited_rows(csv::bytes_of(text), guess.shape.separator);
  const auto report = table::read_table(*rows, "export.csv", guess.shape, meters, calendar, sink);
  if (!report) return require_sentence(report.error().message);
  require(report->readings == readings.size(), "readings are counted");
  for (const csv::LineIssue& issue : report->issues.listed) require_sentence(issue.reason);
  for (const metering::Reading& reading : readings) {
    const csv::MeterInFile& shown = report->meters.at(reading.meter).shown;
    require(!std::isinf(reading.mean_kW), "a reading is finite or blank");
    require((reading.start.time_since_epoch() - shown.phase) % shown.interval ==
                std::chrono::seconds{0},
            "a reading is on its grid");
  }
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald;
  static const auto calendar = metering::LocalCalendar::open("Europe/Berlin");
  const std::string_view text = fuzz::text_of(data, size);
  const auto container = table::guess_container(text.substr(0, 4096));
  if (!container) fuzz::require_sentence(container.error().message);
  for (const char separator : {',', ';', '\t'}) {
    auto guess = table::guess_table(fuzz::rows_of(text, separator));
    if (!guess) {
      fuzz::require_sentence(guess.error().message);
      continue;
    }
    guess->shape.separator = separator;
    fuzz::require_read(text, *guess, *calendar);
  }
  return 0;
}
