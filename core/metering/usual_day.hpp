/// How a meter's load usually runs over the local day, learnt from its readings as they come.
#pragma once

#include <chrono>
#include <vector>

#include "core/metering/interval_book.hpp"
#include "core/metering/reading.hpp"

namespace recald::metering {

/// A running mean of each time of day: the same-time rule for gaps (the seed, section 2) as far as
/// it can be known before the month is over. The last 20 days or so count, all kinds of day alike.
class UsualDay {
 public:
  /// @pre interval divides a day.
  UsualDay(LocalCalendar calendar, std::chrono::seconds interval);

  /// Only what was measured teaches; anything else is left out.
  void observe(const Reading& reading);

  /// Mean power at this time of the local day, kW, never below 0. A time never measured counts as
  /// the mean of the others, and 0 where none was.
  [[nodiscard]] double expected_kW(Instant start) const;

  /// As `book_intervals` takes it. @pre this outlives the shape.
  [[nodiscard]] LoadShape shape() const;

 private:
  struct TimeOfDay {
    double mean_kW = 0.0;
    int days = 0;
  };

  [[nodiscard]] std::size_t index_of(Instant start) const;

  LocalCalendar calendar_;
  std::chrono::seconds interval_;
  std::vector<TimeOfDay> times_;
};

}  // namespace recald::metering
