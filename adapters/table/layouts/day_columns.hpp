/// The columns of a table with a row a day: which of them are times of the day.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace recald::table {

/// Columns of one day's intervals, in order.
struct DayColumns {
  std::size_t first = 0;   ///< Index of the first one.
  std::size_t stride = 1;  ///< 2: a flag stands behind each value.
  int step_min = 0;        ///< Minutes of an interval.
  /// When each column's interval starts, in minutes after midnight as its label has it. Columns
  /// beyond a day of 24 hours go on with 1440.
  std::vector<int> starts_min;
  bool repeats_an_hour = false;  ///< The longer day's hour stands where the clock shows it twice.
  std::string unit;              ///< As the labels say: "KWH_0030"; often empty.

  [[nodiscard]] std::size_t size() const { return starts_min.size(); }
  [[nodiscard]] std::size_t column(std::size_t interval) const { return first + stride * interval; }
  /// Intervals of a day of 24 hours.
  [[nodiscard]] std::size_t usual() const { return static_cast<std::size_t>(1440 / step_min); }
  /// Whether it is one of these, or a flag between them.
  [[nodiscard]] bool covers(std::size_t index) const {
    return index >= first && index < first + stride * size();
  }
};

/// Finds 24, 48, 96, 144 or 288 neighbouring columns whose labels are the times of a day, and those
/// of the 25th hour: "00:15", "0:00-0:15", "00h15", "12:15 AM", "KWH_0030", "0-1", "H01",
/// "Interval 1", "1".
/// @return nothing if there is no such run of labels; of several the first.
[[nodiscard]] std::optional<DayColumns> find_day_columns(std::span<const std::string_view> header);

}  // namespace recald::table
