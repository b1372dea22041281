/// A meter's usual load over the local day, learnt from its readings as they arrive.
#pragma once

#include <chrono>
#include <vector>

#include "core/metering/reading.hpp"
#include "core/metering/registers/interval_book.hpp"

namespace recald::metering {

/// A running mean for each time of day: the same-time rule for gaps (the seed, section 2), as far
/// as possible before the month is over. About the last 20 days count, all kinds of day alike.
class UsualDay {
 public:
  /// @pre interval divides a day.
  UsualDay(LocalCalendar calendar, std::chrono::seconds interval);

  /// Learns only from measured readings.
  void observe(const Reading& reading);

  /// Mean power at this time of the local day, kW, never below 0. A time without measurements gets
  /// the mean of the others, or 0 if there are none.
  [[nodiscard]] double expected_kW(Instant start) const;

  /// In the form that `book_intervals` takes. @pre this outlives the shape.
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
