#include "core/metering/registers/power_book.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/absent.hpp"

namespace recald::metering {
namespace {

using std::chrono::seconds;

/// From one sample to the next.
struct Stretch {
  PowerSample from;
  PowerSample to;
  bool is_measured;

  /// On the straight line between the two samples.
  [[nodiscard]] double power_kW(Instant t) const {
    const double share = in_hours(t - from.time) / in_hours(to.time - from.time);
    return from.power_kW + share * (to.power_kW - from.power_kW);
  }
};

/// Adds [begin, end) of a stretch that lies in the open interval.
void account(PowerBook& book, const Stretch& stretch, Instant begin, Instant end, Reason reasons) {
  const seconds length = end - begin;
  if (!stretch.is_measured) {
    book.hole_longest = std::max(book.hole_longest, length);
    book.reasons |= reasons;
    return;
  }
  book.covered += length;
  book.energy_kWh += in_hours(length) * (stretch.power_kW(begin) + stretch.power_kW(end)) / 2.0;
}

Reading close_interval(PowerBook& book, std::uint32_t meter, const PowerRules& rules) {
  Reading reading{meter, *book.next, kAbsent, Validity::missing, book.reasons};
  const double coverage = in_hours(book.covered) / in_hours(rules.interval);
  if (coverage >= rules.coverage_min && book.hole_longest <= rules.hole_max) {
    reading.mean_kW = book.energy_kWh / in_hours(book.covered);
    reading.validity = Validity::ok;
  } else {
    reading.reasons |= Reason::partial;
  }
  book = {.next = *book.next + rules.interval, .until = book.until, .power_kW = book.power_kW};
  return reading;
}

}  // namespace

std::vector<Reading> book_power(PowerBook& book, std::uint32_t meter, const PowerSample& sample,
                                Reason reasons, const PowerRules& rules) {
  assert(std::isfinite(sample.power_kW));
  if (!book.next) {
    book.next = interval_start(sample.time, rules.interval);
    book.until = *book.next;
  }
  std::vector<Reading> readings;
  const bool is_first = sample.time == book.until && !book.power_kW;
  if (sample.time <= book.until && !is_first) return readings;

  const seconds gap = sample.time - book.until;
  const Stretch stretch{{book.until, book.power_kW.value_or(0.0)},
                        sample,
                        book.power_kW && gap <= std::min(rules.sample_gap_max, rules.hole_max)};
  for (Instant begin = book.until; begin < sample.time;) {
    const Instant end = std::min(*book.next + rules.interval, sample.time);
    account(book, stretch, begin, end, reasons);
    if (end == *book.next + rules.interval) readings.push_back(close_interval(book, meter, rules));
    begin = end;
  }
  book.until = sample.time;
  book.power_kW = sample.power_kW;
  return readings;
}

void forget_power(PowerBook& book) { book.power_kW.reset(); }

}  // namespace recald::metering
