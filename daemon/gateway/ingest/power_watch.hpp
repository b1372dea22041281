/// Watches a live meter's counter by its power: frozen counters, units and scales that differ.
#pragma once

#include <deque>
#include <string>

#include "adapters/ports/store.hpp"
#include "core/metering/power_book.hpp"
#include "core/metering/power_check.hpp"

namespace recald::daemon {

/// Samples of the power and intervals of the counter come in any order; an interval is judged once
/// both are known. Nothing of it is stored: after a restart a run begins anew.
class PowerWatch {
 public:
  PowerWatch(std::uint32_t meter, std::string id, const metering::PowerRules& rules)
      : meter_(meter), id_(std::move(id)), rules_(rules) {}

  void take_power(const metering::PowerSample& sample);
  void take_interval(const metering::Reading& counted);

  /// Puts what was found into the batch: intervals that take the place of those that were booked,
  /// and events.
  /// @param counter  As it is now; its rating and resolution are what the power is judged by.
  void judge(StoreBatch& batch, const metering::CounterSettings& counter, metering::Instant at);

  void clock_was_set() { metering::forget_power(book_); }

 private:
  std::uint32_t meter_;
  std::string id_;
  metering::PowerRules rules_;
  metering::PowerBook book_;
  metering::PowerCheck check_;
  std::deque<metering::Reading> counted_;  ///< Without their power yet, in order of time.
  std::deque<metering::Reading> powered_;  ///< Without their counter yet.
};

}  // namespace recald::daemon
