/// What is in an export that nobody described: its meters, and how to read them.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adapters/table/read_table.hpp"
#include "adapters/table/sniff.hpp"
#include "core/metering/civil_time.hpp"
#include "core/metering/reading.hpp"
#include "core/result.hpp"
#include "daemon/site/replay/register_evidence.hpp"
#include "daemon/site/setup/meter_sums.hpp"
#include "daemon/site/setup/survey_hints.hpp"

namespace recald::daemon {

/// A value of a site file, and why it is what it is.
template <class T>
struct Guess {
  T value;
  std::string because;
};

inline constexpr int kCertainStamps = 3;  ///< Said by the file, not by where it begins and ends.

struct SurveyedMeter {
  std::string name;          ///< As people call it.
  std::string name_in_file;  ///< In the meter column of a long table; else empty.
  std::string column;
  std::vector<std::string> further_names{};    ///< Rows of the same load.
  std::vector<std::string> further_columns{};  ///< Columns of the same load.
  std::string parts_because;                   ///< Why these are one load.
  Guess<std::string> unit;
  Guess<metering::Utility> utility;
  Guess<csv::Stamps> stamps{csv::Stamps::start, ""};
  int stamps_weight = 0;  ///< Of the evidence for it; 0: guessed.
  bool is_named_by_file = false;
  std::chrono::seconds interval{0};
  bool is_of_other_steps = false;    ///< Its rows come at others than its interval.
  bool needs_heating_value = false;  ///< Gas by volume.
  bool is_register = false;
  bool is_told_kind = false;               ///< Other files say whether it is a register.
  RegisterVerdict as_register;             ///< Of a register: of what kind, and more.
  std::chrono::seconds grid_tolerance{0};  ///< Its stamps lie beside the grid by so much.
  double zero_share = 0.0;
  double frozen_share = 0.0;  ///< In runs of equal values longer than a meter is believed to have.
  double negative_share = 0.0;
  std::uint64_t readings = 0;
  std::uint64_t values = 0;  ///< Of these, not blank.
  std::uint64_t refused = 0;
  double mean_kW = 0.0;  ///< Of the values; while the unit is unknown as if it were kWh.
  metering::TimeSpan span{};
  SampledReadings samples;
};

struct SurveyedExport {
  std::vector<std::filesystem::path> files;  ///< Several: the later counts where they overlap.
  std::optional<table::TableGuess> table;    ///< None: recald's own CSV.
  std::vector<SurveyedMeter> meters;
  std::vector<std::string> notes;       ///< A sentence each: what is undecided, or left out.
  std::vector<OpenQuestion> questions;  ///< What has to be known before it can be read.
  table::ClockFacts clock;              ///< What its stamps show of clock changes.
  std::string clock_because;   ///< Why the table has a zone of its own; empty: it has none.
  std::string layout_because;  ///< Why its times are taken to run that way.
  std::optional<std::chrono::seconds> told_interval;  ///< Of its values, if somebody said so.
  std::string clock_format_because;                   ///< Of a clock column that counts.
  std::optional<std::chrono::seconds> utc_offset;     ///< Of its first stamp, if stamps say theirs.
};

inline constexpr double kMonth_h = 730.0;  ///< A twelfth of a year.

/// Three digits, or all before the point: "3.55", "41.2", "3555".
[[nodiscard]] std::string amount_text(double value);

/// Looks at the first rows, then reads the file to its end the way that `replay` would. Memory does
/// not grow with its length.
/// @param calendar  Of the site; absent: nobody gave a zone.
/// @return a sentence that names the file: it cannot be understood, its stamps need a zone, they
///         are out of order, too many of its rows would be refused.
[[nodiscard]] Result<SurveyedExport> survey_export(
    const std::filesystem::path& file, const std::optional<metering::LocalCalendar>& calendar,
    const SurveyHints& hints = {});

/// Whether its stamps say neither their offset from UTC nor their zone. Reads the first rows, of a
/// table with a column of meters all.
[[nodiscard]] Result<bool> needs_timezone(const std::filesystem::path& file);

}  // namespace recald::daemon
