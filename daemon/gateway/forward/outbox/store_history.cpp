#include "daemon/gateway/forward/outbox/store_history.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::days;
using std::chrono::seconds;

// A number has the meter's, the day since 1970 and a place in that day: 1 + its minute, so that no
// interval shares it. Months stand at a day beyond all others.
constexpr std::int64_t kPerDay = 10'000;
constexpr std::int64_t kMonthsDay = 99'999;
constexpr std::int64_t kPerMeter = (kMonthsDay + 1) * kPerDay;

std::int64_t number_of(std::int64_t meter, Instant start) {
  const auto day = std::chrono::floor<days>(start);
  const auto minute = std::chrono::duration_cast<std::chrono::minutes>(start - day).count();
  return meter * kPerMeter + day.time_since_epoch().count() * kPerDay + 1 + minute;
}

/// Where the intervals go on after such a number of the same meter.
Instant start_after(std::int64_t in_meter) {
  const Instant day{std::chrono::sys_days{days{in_meter / kPerDay}}};
  return day + std::chrono::minutes{in_meter % kPerDay};
}

class Collected {
 public:
  Collected(Store& store, int limit) : store_(store), limit_(limit) {}

  [[nodiscard]] bool is_full() const { return static_cast<int>(entries.size()) >= limit_; }

  /// Day by day, so that a long record is never in memory.
  Result<void> add_intervals(std::uint32_t number, const MeterInStore& meter, Instant from) {
    const auto extent = TRY(store_.interval_extent(number));
    if (!extent) return {};
    Instant at = std::max(from, extent->begin);
    while (!is_full() && at <= extent->end) {
      const Instant next = std::chrono::floor<days>(at) + days{1};
      auto read = store_.for_each_interval(number, {at, next}, [&](const StoredInterval& one) {
        if (is_full()) return;
        entries.push_back({.number = number_of(number, one.reading.start),
                           .meter = meter.id,
                           .interval = meter.interval,
                           .stored = one});
      });
      if (!read) return read;
      at = next;
    }
    return {};
  }

  Result<void> add_months(std::uint32_t number, const MeterInStore& meter, std::int64_t after) {
    const auto months = TRY(store_.months(number));
    for (std::size_t i = 0; i < months.size() && !is_full(); ++i) {
      const std::int64_t place =
          number * kPerMeter + kMonthsDay * kPerDay + 1 + static_cast<std::int64_t>(i);
      if (place <= after) continue;
      entries.push_back(
          {.number = place, .meter = meter.id, .interval = meter.interval, .stored = months[i]});
    }
    return {};
  }

  std::vector<OutboxEntry> entries;

 private:
  Store& store_;
  int limit_;
};

}  // namespace

Result<std::vector<OutboxEntry>> history_after(Store& store,
                                               const std::vector<MeterInStore>& meters,
                                               std::int64_t after, int limit) {
  std::map<std::uint32_t, const MeterInStore*> by_number;
  for (const MeterInStore& meter : meters) {
    const auto number = TRY(store.find_meter(meter.id));
    if (number) by_number[*number] = &meter;
  }
  Collected collected{store, limit};
  for (const auto& [number, meter] : by_number) {
    const std::int64_t first = number * kPerMeter;
    if (collected.is_full() || after >= first + kPerMeter) continue;
    const std::int64_t in_meter = std::max<std::int64_t>(after - first, 0);
    if (in_meter < kMonthsDay * kPerDay) {
      TRY(collected.add_intervals(number, *meter, start_after(in_meter)));
    }
    TRY(collected.add_months(number, *meter, after));
  }
  return std::move(collected.entries);
}

}  // namespace recald::daemon
