/// Checks a live meter's counter against its power: frozen counters, different units and scales.
#pragma once

#include <deque>
#include <string>

#include "adapters/ports/store.hpp"
#include "core/metering/registers/power_book.hpp"
#include "core/metering/registers/power_check.hpp"

namespace recald::daemon {

/// Samples of the power and intervals of the counter come in any order; an interval is checked once
/// both are known. Nothing is stored: after a restart a run starts again.
class PowerWatch {
 public:
  PowerWatch(std::uint32_t meter, std::string id, const metering::PowerRules& rules)
      : meter_(meter), id_(std::move(id)), rules_(rules) {}

  void take_power(const metering::PowerSample& sample);
  void take_interval(const metering::Reading& counted);

  /// Adds the findings to the batch: intervals that replace booked ones, and events.
  /// @param counter  Current settings; the power is judged by its rating and resolution.
  void evaluate(StoreBatch& batch, const metering::CounterSettings& counter, metering::Instant at);

  void clock_was_set() { metering::forget_power(book_); }

 private:
  std::uint32_t meter_;
  std::string id_;
  metering::PowerRules rules_;
  metering::PowerBook book_;
  metering::PowerCheck check_;
  std::deque<metering::Reading> counted_;  ///< Their power is not known yet; in order of time.
  std::deque<metering::Reading> powered_;  ///< Their counter is not known yet.
};

}  // namespace recald::daemon
