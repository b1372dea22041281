/// Recorded meter readings: `timestamp,meter,value,unit`, read as a stream.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/line_issues.hpp"
#include "adapters/csv/other_meters.hpp"
#include "adapters/csv/row_steps.hpp"
#include "core/metering/reading.hpp"
#include "core/metering/registers/interval_book.hpp"
#include "core/metering/registers/late_stamps.hpp"
#include "core/metering/units.hpp"
#include "core/result.hpp"

namespace recald::csv {

/// How to read the rows of one meter. Its position in the list is `Reading::meter`.
struct MeterRows {
  std::string name;  ///< As in the `meter` column.
  metering::Utility utility = metering::Utility::electricity;
  Stamps stamps = Stamps::start;
  std::optional<std::chrono::seconds> interval;  ///< Absent: inferred from its first rows.
  metering::UnitFactors units;
  double multiplier = 1.0;  ///< Current-transformer ratio not yet applied in the file.
  /// If set, values are readings of a cumulative register in an energy unit. Readings of such a
  /// meter come at the end of the file; its samples are held until then.
  std::optional<metering::CounterSettings> counter;
  metering::ResetTimes resets = {};  ///< Of a counter that sets itself to zero.
  /// Stamps this far beside the grid of intervals are put on it; at most a fifth of the interval.
  std::chrono::seconds grid_tolerance{0};
};

struct ReadingsOptions {
  std::vector<MeterRows> meters;
  bool add_unlisted_meters = false;  ///< Append meters of the file that are not listed.
  /// Of meters without a tolerance: whether the largest one is taken where stamps need it.
  bool finds_tolerance = false;
  std::size_t issues_listed_max = 100;
};

/// What the file shows about a meter; reported before its first reading.
struct MeterInFile {
  std::uint32_t meter = 0;
  std::string name;
  std::chrono::seconds interval{0};  ///< 0 when the file has no usable row of this meter.
  std::chrono::seconds phase{0};  ///< By which interval starts lie after multiples of the interval.
  bool interval_inferred = false;
  std::string unit;  ///< From its first row.
};

/// A row as it is, whatever its interval.
struct RawRow {
  std::uint32_t meter;
  metering::Instant stamp;
  double value;  ///< In kW of a rate, else in kWh; NaN: blank.
  bool is_rate;
};

struct ReadingsSink {
  std::function<void(const MeterInFile&)> on_meter;
  std::function<void(const metering::Reading&)> on_reading;
  std::function<void(const RawRow&)> on_row = {};
};

/// Totals of one meter.
struct MeterReport {
  MeterInFile shown;
  std::uint64_t readings = 0;  ///< Passed to the sink, blanks included.
  std::uint64_t blanks = 0;    ///< Rows without a value.
  std::uint64_t unsorted =
      0;  ///< Older than the previous row; passed on, since the closer handles late ones.
  std::uint64_t conflicts = 0;   ///< Of the duplicates, those with another value.
  std::uint64_t duplicates = 0;  ///< Same stamp as the previous row; passed on, the closer decides.
  std::uint64_t off_grid = 0;    ///< Refused.
  /// How far stamps lay beside the grid that they were put on, at most.
  std::chrono::seconds beside_max{0};
  std::vector<RowStep> steps;  ///< In order; the first is the one at the beginning. Up to twenty.
  std::vector<metering::RegisterNote> register_notes;
  metering::StampsBeside stamps_beside = metering::StampsBeside::none;  ///< Of a register.
  std::uint64_t refused = 0;               ///< Rows known to be of this meter that were refused.
  std::vector<LineIssue> first_refused;    ///< Up to three of them.
  std::optional<metering::TimeSpan> span;  ///< From the earliest start to the latest end.
};

struct ReadingsReport {
  std::uint64_t lines = 0;     ///< Data lines, good and bad, without header and comments.
  std::uint64_t readings = 0;  ///< Passed to the sink.
  LineIssues issues;
  OtherMeters others;               ///< Meters of the file whose lines were left out.
  std::vector<MeterReport> meters;  ///< In the order of the options' list, then of appearance.
};

/// Reads a file once, from start to end, in chunks; memory does not grow with its length.
///
/// RFC 4180 with quotes (a line break inside quotes is a bad line), UTF-8 with or without a byte
/// order mark, LF or CRLF, lines up to 64 KiB, `#` lines skipped, a dot as the decimal sign in any
/// locale. `timestamp` is ISO 8601 with an offset or Z; it marks the interval's start unless
/// `stamps` says end. A blank value is a reading that the source lists as blank (NaN). Further
/// columns `validity`, `late`, `reasons` (joined by |) may follow. A bad line is reported with its
/// number and skipped. A last line without a line end counts only when its unit is the one its
/// meter had before: a file cut inside "kWh" must not become kW.
///
/// @return the report, or
///         not_found  no such file;  io_failed  it cannot be read to its end;
///         malformed  the header is not the expected one, which the message names, or is empty.
[[nodiscard]] Result<ReadingsReport> read_readings(const std::filesystem::path& file,
                                                   const ReadingsOptions& options,
                                                   const ReadingsSink& sink);

class ReadingIntake;

/// As above, into an intake that continues with further files of the same meters.
/// @param options  Those of the intake.
[[nodiscard]] Result<void> read_readings(const std::filesystem::path& file,
                                         const ReadingsOptions& options, ReadingIntake& intake);

/// As above, from memory; messages use `name` for the file.
[[nodiscard]] Result<ReadingsReport> read_readings_text(std::string_view text,
                                                        std::string_view name,
                                                        const ReadingsOptions& options,
                                                        const ReadingsSink& sink);

}  // namespace recald::csv
