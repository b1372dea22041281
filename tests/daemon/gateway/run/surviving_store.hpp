/// What a store must still hold after whatever happened to it.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"

namespace recald::daemon::testing {

/// An interval that a commit has promised to keep.
struct Promise {
  std::uint32_t meter;
  metering::Instant start;
  double mean_kW;
};

inline void promise(const StoreBatch& batch, std::vector<Promise>& promises) {
  for (const StoreBatch::Interval& interval : batch.intervals) {
    promises.push_back({interval.reading.meter, interval.reading.start, interval.reading.mean_kW});
  }
}

/// One that is made again from samples may differ from the first in its last bits.
inline constexpr double kRounding_kW = 1e-9;

/// Looks for promised intervals, for intervals that stand twice or apart, for states that do not
/// stand with their intervals, and for what the store itself finds.
/// @param meters    Numbers 0 to meters − 1, each with intervals of a quarter of an hour.
/// @param promises  None of them superseded; each is kept within the tolerance.
/// @return what is wrong; empty: nothing.
inline std::string what_is_wrong(Store& store, std::uint32_t meters,
                                 std::span<const Promise> promises,
                                 double tolerance_kW = kRounding_kW) {
  const auto checked = store.check();
  if (!checked) return checked.error().message;
  if (!checked->damage.empty()) return checked->damage;
  if (!checked->problems.empty()) return checked->problems.front();
  std::vector<std::vector<metering::Reading>> stored(meters);
  for (std::uint32_t meter = 0; meter < meters; ++meter) {
    auto& readings = stored[meter];
    const auto read = store.for_each_interval(
        meter, {metering::Instant::min(), metering::Instant::max()},
        [&](const StoredInterval& interval) { readings.push_back(interval.reading); });
    if (!read) return read.error().message;
    for (std::size_t i = 1; i < readings.size(); ++i) {
      if (readings[i].start - readings[i - 1].start == std::chrono::seconds{900}) continue;
      return fmt::format("meter {}: {} follows {}", meter, metering::to_string(readings[i].start),
                         metering::to_string(readings[i - 1].start));
    }
    const auto states = store.registers(meter);
    if (!states) return states.error().message;
    if (states->empty() || readings.empty()) {
      if (readings.empty()) continue;
      return fmt::format("meter {} has intervals and no state", meter);
    }
    if (states->front().book.next != readings.back().start + std::chrono::seconds{900}) {
      const auto& next = states->front().book.next;
      return fmt::format("meter {}: the state stands at {}, the last interval begins at {}", meter,
                         next ? metering::to_string(*next) : "nothing",
                         metering::to_string(readings.back().start));
    }
  }
  for (const Promise& one : promises) {
    const auto& readings = stored.at(one.meter);
    const auto found = std::ranges::lower_bound(readings, one.start, {}, &metering::Reading::start);
    const bool is_there = found != readings.end() && found->start == one.start &&
                          (std::abs(found->mean_kW - one.mean_kW) <= tolerance_kW ||
                           (std::isnan(found->mean_kW) && std::isnan(one.mean_kW)));
    if (is_there) continue;
    return fmt::format("meter {}: {} was acknowledged and is lost", one.meter,
                       metering::to_string(one.start));
  }
  return "";
}

}  // namespace recald::daemon::testing
