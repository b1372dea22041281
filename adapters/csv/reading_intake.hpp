/// Turns rows of meters into readings on their intervals, whatever kind of file they come from.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/readings_csv.hpp"
#include "core/metering/registers/interval_means.hpp"

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

/// A row that waits, with its line, which is gone by the time the row is passed on.
struct WaitingRow {
  Row row;
  std::string text;
};

/// A meter whose rows are being read.
struct IntakeMeter {
  /// A value over a span that the next row ends.
  struct OpenSpan {
    metering::Reading value;
    std::chrono::seconds length;
    bool is_rate;
  };

  MeterRows rows;
  MeterReport report;
  std::string unit;  ///< Text of the previous row, and its meaning.
  metering::UnitConversion conversion{};
  bool grid_known = false;
  bool refused = false;  ///< No usable interval.
  double kW_per_unit = 0.0;
  std::vector<WaitingRow> head;
  std::vector<metering::RegisterSample> samples;

  std::chrono::seconds step{0};       ///< From one row to the next.
  std::chrono::seconds tolerance{0};  ///< Within which stamps are put on the grid.
  bool is_irregular = false;          ///< A rate whose rows come at any time.
  /// Whether rows are the meter's intervals and none waits.
  bool is_plain = true;
  std::optional<metering::Reading> held;  ///< The latest one, until the next row shows its length.
  std::vector<WaitingRow> waiting;        ///< Rows that may come at another step from now on.
  std::optional<metering::IntervalMeans> means;  ///< If rows are not the meter's intervals.
  std::optional<OpenSpan> open;                  ///< The latest value for the means.

  std::optional<metering::Instant> last;         ///< Stamp of the previous row.
  std::optional<metering::Instant> newest;       ///< Latest stamp so far.
  std::optional<metering::Instant> first_start;  ///< Of readings passed on: the earliest start
  std::optional<metering::Instant> last_start;   ///< … and the latest.
  // In this file:
  std::uint64_t placed = 0;      ///< Rows.
  std::uint64_t follows = 0;     ///< Of these, rows directly after the previous one.
  std::uint64_t left_out = 0;    ///< Of these, rows at a step that is longer than the interval.
  std::optional<Row> longer;     ///< The latest row of a longer step; the next one ends its time.
  std::vector<Row> longer_head;  ///< Such rows, before the interval was known.
  bool has_earlier_file = false;
  bool begins_file = false;  ///< No row of this file has been placed.
};

/// What to report about one file besides its readings.
struct FileReport {
  LineIssues issues;
  OtherMeters others;  ///< Their lines were left out.
};

/// Finds each meter's interval in its first rows, shifts end stamps, converts units, takes
/// differences of counters, and reports what is out of order. Rows at other steps than the
/// interval, such as every ten seconds, are averaged; where the step changes, the rows around show
/// it. Memory does not grow with the file, except for the samples of counters.
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
    if (sink_.on_row) show_row(meter, row);
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
  bool find_step(IntakeMeter& meter);
  bool find_register_interval(IntakeMeter& meter);
  void drop_coarse_head(IntakeMeter& meter);
  bool refuse_meter(IntakeMeter& meter, const std::string& why);
  static void set_scale(IntakeMeter& meter);
  void show_row(const IntakeMeter& meter, const Row& row) const;

  void find_tolerance(IntakeMeter& meter);
  [[nodiscard]] static std::chrono::seconds beside_grid(std::chrono::seconds interval,
                                                        metering::Instant stamp);
  [[nodiscard]] static metering::Instant on_grid(IntakeMeter& meter, metering::Instant stamp);
  static void use_means(IntakeMeter& meter);
  static void find_way(IntakeMeter& meter);
  void take_odd(IntakeMeter& meter, const Row& row, metering::Instant stamp);
  void settle(IntakeMeter& meter);
  void begin_step(IntakeMeter& meter, const Row& row, std::chrono::seconds step, bool is_of_held);
  static void note_step(IntakeMeter& meter, const Row& row, std::chrono::seconds step);
  void place(IntakeMeter& meter, const Row& row, metering::Instant stamp);
  void leave_out(IntakeMeter& meter, const Row& row);
  void take_longer(IntakeMeter& meter, const Row& row, metering::Instant stamp);
  void end_longer(IntakeMeter& meter, metering::Instant next);
  void spread(IntakeMeter& meter, const Row& row, const metering::TimeSpan& span);
  void add_to_means(IntakeMeter& meter, const Row& row, metering::Instant stamp);
  void close_open(IntakeMeter& meter, std::optional<metering::Instant> until);
  bool check_known_years(IntakeMeter& meter, const Row& row, metering::Instant start);
  bool check_grid(IntakeMeter& meter, const Row& row, metering::Instant start);
  void check_order(IntakeMeter& meter, const Row& row, metering::Instant start);
  void pass_on_all(IntakeMeter& meter);
  void end_meter(IntakeMeter& meter);
  void keep_sample(IntakeMeter& meter, const Row& row);
  void finish_counter(IntakeMeter& meter);

  /// The row's mean power, if it is one of the meter's intervals.
  [[nodiscard]] static metering::Reading reading_of(const IntakeMeter& meter, const Row& row,
                                                    metering::Instant start) {
    const MeterInFile& shown = meter.report.shown;
    const bool usual_unit = row.conversion.factor == meter.conversion.factor &&
                            row.conversion.is_rate == meter.conversion.is_rate;
    const double mean_kW =
        usual_unit ? row.value * meter.kW_per_unit
                   : row.conversion.mean_kW(row.value * meter.rows.multiplier, shown.interval);
    return {shown.meter, start, mean_kW, row.validity, row.reasons, row.late};
  }

  [[nodiscard]] static metering::Instant start_of(const IntakeMeter& meter,
                                                  metering::Instant stamp) {
    return meter.rows.stamps == Stamps::end ? stamp - meter.report.shown.interval : stamp;
  }

  void hand_on(IntakeMeter& meter, const Row& row) {
    const metering::Instant stamp =
        meter.tolerance == std::chrono::seconds{0} ? row.stamp : on_grid(meter, row.stamp);
    const bool follows = meter.is_plain && meter.last && stamp == *meter.last + meter.step &&
                         meter.last == meter.newest;
    if (!follows) return take_odd(meter, row, stamp);
    ++meter.placed;
    ++meter.follows;
    meter.last = meter.newest = stamp;
    hold(meter, reading_of(meter, row, start_of(meter, stamp)));
  }

  /// Passes on the reading before: the next row may show that this one is no whole interval.
  void hold(IntakeMeter& meter, const metering::Reading& reading) {
    if (meter.held) pass_on(meter, *meter.held);
    meter.held = reading;
  }

  void pass_on(IntakeMeter& meter, const metering::Reading& reading) {
    ++meter.report.readings;
    if (std::isnan(reading.mean_kW)) ++meter.report.blanks;
    if (!meter.first_start || reading.start < *meter.first_start) meter.first_start = reading.start;
    if (!meter.last_start || reading.start > *meter.last_start) meter.last_start = reading.start;
    if (sink_.on_reading) sink_.on_reading(reading);
  }

  const ReadingsSink& sink_;
  bool finds_tolerance_;
  std::vector<IntakeMeter> meters_;
  ReadingsReport report_;
};

}  // namespace recald::csv
