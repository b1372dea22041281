/// Turns rows of meters into readings on their intervals, whatever kind of file they come from.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/readings_csv.hpp"

namespace recald::csv {

inline constexpr double kValueMax = 1e18;  ///< Keeps values finite after any unit and multiplier.

/// One row, before its interval is applied.
struct Row {
  std::uint64_t line;
  metering::Instant stamp;
  double value;  ///< In the row's unit; NaN: blank.
  metering::UnitConversion conversion;
  metering::Validity validity = metering::Validity::ok;
  metering::Reason reasons = metering::Reason::none;
  bool late = false;
  std::string_view text = {};  ///< The whole line, for messages.
};

/// A meter whose rows are being read.
struct IntakeMeter {
  struct HeadRow {
    Row row;
    std::string text;  ///< The row's line, which is gone by the time the row is passed on.
  };

  MeterRows rows;
  MeterReport report;
  std::string unit;  ///< Text of the previous row, and its meaning.
  metering::UnitConversion conversion{};
  bool grid_known = false;
  bool refused = false;  ///< No usable interval.
  double kW_per_unit = 0.0;
  std::vector<HeadRow> head;
  std::vector<metering::RegisterSample> samples;
  std::optional<metering::Instant> last;           ///< Start of the previous row.
  std::optional<metering::Instant> newest;         ///< Latest start of this file …
  std::optional<metering::Instant> newest_of_all;  ///< … and of those before.
  std::optional<metering::Instant> earliest;
  std::uint64_t readings_before = 0;  ///< In earlier files.
  std::uint64_t follows = 0;          ///< In this file: readings directly after the previous one.
};

/// What to report about one file besides its readings.
struct FileReport {
  LineIssues issues;
  OtherMeters others;  ///< Their lines were left out.
};

/// Finds each meter's interval in its first rows, shifts end stamps, converts units, takes
/// differences of counters, and reports what is out of order. Memory does not grow with the file,
/// except for the samples of counters.
class ReadingIntake {
 public:
  /// @param options, sink  Outlive this.
  ReadingIntake(const ReadingsOptions& options, const ReadingsSink& sink);

  std::uint32_t add_meter(const MeterRows& rows);
  [[nodiscard]] std::size_t size() const { return meters_.size(); }
  [[nodiscard]] IntakeMeter& meter(std::size_t index) { return meters_[index]; }

  /// Sets the unit of a meter's rows from here on. @return or what is wrong with the unit
  [[nodiscard]] Result<void> set_unit(IntakeMeter& meter, std::string_view unit);

  /// @pre the row's conversion is set
  void take(IntakeMeter& meter, const Row& row) {
    if (meter.grid_known && !meter.rows.counter) {
      hand_on(meter, row);
    } else {
      take_first(meter, row);
    }
  }

  /// Refuses a line that belongs to no known meter, or to `meter` but is unusable.
  void refuse(std::uint64_t line, std::string_view reason, std::string_view text,
              IntakeMeter* meter = nullptr);

  void count_line() { ++report_.lines; }
  void count_other(std::string_view meter) { report_.others.add(meter); }

  /// Ends one file of several with the same meters, in order of time, and reports on it.
  /// @return or malformed: a meter's interval differs from that in the earlier files.
  [[nodiscard]] Result<FileReport> end_file(std::string_view name);

  /// Passes on the waiting rows and sums up. Do not use the intake afterwards.
  [[nodiscard]] ReadingsReport finish();

 private:
  void take_first(IntakeMeter& meter, const Row& row);
  void begin_meter(IntakeMeter& meter);
  bool find_grid(IntakeMeter& meter);
  void set_scale(IntakeMeter& meter);
  bool check_order(IntakeMeter& meter, const Row& row, metering::Instant start);
  void keep_sample(IntakeMeter& meter, const Row& row);
  void finish_counter(IntakeMeter& meter);

  void hand_on(IntakeMeter& meter, const Row& row) {
    const MeterInFile& shown = meter.report.shown;
    const metering::Instant start =
        meter.rows.stamps == Stamps::end ? row.stamp - shown.interval : row.stamp;
    const bool follows =
        meter.last && start == *meter.last + shown.interval && meter.last == meter.newest;
    if (!follows && !check_order(meter, row, start)) return;
    if (follows) ++meter.follows;
    meter.last = start;
    if (!meter.newest || start > *meter.newest) meter.newest = start;
    ++meter.report.readings;
    if (std::isnan(row.value)) ++meter.report.blanks;
    const bool usual_unit = row.conversion.factor == meter.conversion.factor &&
                            row.conversion.is_rate == meter.conversion.is_rate;
    const double mean_kW =
        usual_unit ? row.value * meter.kW_per_unit
                   : row.conversion.mean_kW(row.value * meter.rows.multiplier, shown.interval);
    if (sink_.on_reading) {
      sink_.on_reading({shown.meter, start, mean_kW, row.validity, row.reasons, row.late});
    }
  }

  const ReadingsSink& sink_;
  std::vector<IntakeMeter> meters_;
  ReadingsReport report_;
};

}  // namespace recald::csv
