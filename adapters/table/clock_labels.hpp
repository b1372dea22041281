/// Columns that count the hours or intervals of a day, and what they do on days of 23 and 25 hours.
#pragma once

#include <array>
#include <bitset>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "adapters/table/row_source.hpp"
#include "adapters/table/table_shape.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::table {

inline constexpr int kLabelsMax =
    300;  ///< A day of 25 hours has as many intervals of five minutes.

/// "7", "07", "H07", "SP 7", "7.0": the number of an hour or an interval. @return 0…kLabelsMax
[[nodiscard]] std::optional<int> parse_label(std::string_view text);

/// The number of the interval that ends at "07:00", at "25:00" of a long day, or of a label.
[[nodiscard]] std::optional<int> label_of(std::string_view text, std::chrono::seconds interval);

/// Length of the intervals of which a day has this many: 24, 48, 96, 144 or 288.
[[nodiscard]] std::optional<std::chrono::seconds> interval_of_labels(int labels);

/// What a cell of a table's clock column adds to its date, as if each day had 24 hours.
/// @return nothing: it is no time, and no number where the column counts
[[nodiscard]] std::optional<std::chrono::seconds> time_of_clock_cell(std::string_view text,
                                                                     const TableShape& shape);

/// What the days of a table show of its clock column.
struct ClockLabels {
  std::optional<ClockFormat> format;
  std::string because;  ///< Of the format; without one: the day that leaves it open, and how.
};

/// Collects labels, date by date, of a whole table, and compares the days on which the clock is
/// changed with what each format would have there.
class LabelledDays {
 public:
  /// @param label     From 1.
  /// @param is_empty  No value, or zero, as some write for an hour that a day lacks.
  void take(std::chrono::sys_days date, int label, bool is_empty);

  /// Most days have this many labels.
  [[nodiscard]] int usual_labels() const;

  /// @param without_change  The format of a table with no such day, where all mean the same.
  [[nodiscard]] ClockLabels decide(const metering::LocalCalendar& calendar,
                                   ClockFormat without_change) const;

 private:
  struct Labels {
    std::array<std::uint16_t, kLabelsMax + 1> rows{};  ///< With each label.
    std::bitset<kLabelsMax + 1> filled;
  };
  struct Range;
  struct Change;
  [[nodiscard]] std::optional<ClockFormat> format_on(const Labels& labels,
                                                     const Change& change) const;

  std::map<std::chrono::sys_days, Labels> dates_;
};

/// Reads a table to its end for the labels of its clock column.
/// @param values  Columns with values.
/// @return the format; `time` too where times lie between the ends of intervals, as of a file whose
///         intervals change
/// @return malformed: nothing decides, or days contradict each other; the sentence says which, and
///         to give `clock_format`.
[[nodiscard]] Result<ClockLabels> read_clock_labels(RowSource& rows, const TableShape& shape,
                                                    std::span<const std::string> values,
                                                    const metering::LocalCalendar& calendar,
                                                    ClockFormat without_change);

}  // namespace recald::table
