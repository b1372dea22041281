/// How much of the current month is measured so far.
#pragma once

#include <chrono>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/metering/reading.hpp"

namespace recald::daemon {

/// One meter's. Told each interval that is committed, and after a restart those that are stored, in
/// order of their starts or nearly so; keeps a bit a slot.
class OpenMonth {
 public:
  OpenMonth(metering::LocalCalendar calendar, std::chrono::seconds interval);

  void observe(const metering::Reading& reading);

  /// Share, 0…1, of the slots that have ended by `now` that are measured and valid; NaN before the
  /// month's first slot has ended. A slot that ended less than a minute ago does not count yet: it
  /// is booked with the first read after its end.
  [[nodiscard]] double coverage(metering::Instant now) const;

 private:
  metering::LocalCalendar calendar_;
  std::chrono::seconds interval_;
  metering::TimeSpan span_{};      ///< Of the latest month that has a reading.
  std::vector<bool> is_measured_;  ///< By slot of that month.
};

}  // namespace recald::daemon
