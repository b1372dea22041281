/// The energy and the peak of a month that goes on, from its intervals in order of time.
#pragma once

#include <chrono>
#include <optional>

#include "core/absent.hpp"
#include "core/metering/reading.hpp"

namespace recald::daemon {

/// As `metering::close_month` has them, but of the intervals alone that are there: nothing is
/// filled, and a spike that only the whole month shows is not found.
class MonthSoFar {
 public:
  MonthSoFar(metering::Meter meter, metering::LocalCalendar calendar, metering::Month month);

  /// Ignores what starts before the one taken last, or outside the month.
  void take(const metering::Reading& reading);

  [[nodiscard]] metering::Month month() const { return month_; }
  /// Where the next interval begins: those from here on are to be taken.
  [[nodiscard]] metering::Instant next() const { return next_; }
  [[nodiscard]] const metering::TimeSpan& span() const { return span_; }

  /// Mean over the known intervals, times a day; NaN without any.
  [[nodiscard]] double daily_average_kWh() const;
  /// Largest mean over complete blocks of the meter's window; NaN without any.
  [[nodiscard]] double peak_kW() const { return peak_kW_; }

 private:
  void take_block(const metering::Reading& reading);

  metering::Meter meter_;
  metering::LocalCalendar calendar_;
  metering::Month month_;
  metering::TimeSpan span_;
  metering::Instant next_;
  double sum_kW_ = 0.0;
  int known_ = 0;
  int block_length_;  ///< Intervals.
  int in_block_ = 0;  ///< Measured ones in a row since the block's start; 0: no block.
  double block_sum_kW_ = 0.0;
  double peak_kW_ = kAbsent;
};

}  // namespace recald::daemon
