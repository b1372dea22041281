/// How much of the current month is measured so far.
#pragma once

#include <chrono>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/metering/reading.hpp"

namespace recald::daemon {

/// For one meter. Takes each committed interval, and after a restart the stored ones, roughly in
/// order of their starts. Keeps one bit per slot.
class OpenMonth {
 public:
  OpenMonth(metering::LocalCalendar calendar, std::chrono::seconds interval);

  void observe(const metering::Reading& reading);

  /// Share, 0…1, of the slots ended by `now` that have a valid measurement; NaN before the month's
  /// first slot has ended. A slot that ended less than a minute ago does not count yet, because it
  /// is booked with the first read after its end.
  [[nodiscard]] double coverage(metering::Instant now) const;

 private:
  metering::LocalCalendar calendar_;
  std::chrono::seconds interval_;
  metering::TimeSpan span_{};      ///< Of the latest month that has a reading.
  std::vector<bool> is_measured_;  ///< By slot of that month.
};

}  // namespace recald::daemon
