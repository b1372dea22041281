/// Progress of a meter whose readings are in the store, whether they are polled or pushed.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"
#include "daemon/gateway/ingest/open_month.hpp"
#include "daemon/site/config/weather_sensors.hpp"

namespace recald::daemon {

/// Counts of a meter since the process started.
struct MeterCounters {
  std::array<std::uint64_t, 5> intervals{};     ///< Committed, by Validity.
  std::uint64_t late = 0;                       ///< Of these, the ones for closed months.
  std::map<std::string, std::uint64_t> events;  ///< By kind.
};

struct MeterProgress {
  StoredMeter stored;
  /// The quantity of a weather sensor; absent: a meter, whose months close.
  std::optional<WeatherChannel> channel = {};
  OpenMonth open_month;
  MeterCounters counters{};
  std::optional<metering::Reading> last_interval = {};        ///< Committed.
  metering::Instant closed_until = metering::Instant::min();  ///< End of the last closed month.
  /// The latest unbroken run of valid intervals with the same value.
  std::optional<metering::TimeSpan> same_value = {};
  double same_value_is = 0.0;

  /// End of the latest valid interval; nothing if there is none yet, or none within a month.
  [[nodiscard]] std::optional<metering::Instant> known_until() const {
    return same_value ? std::optional{same_value->end} : std::nullopt;
  }

  /// Registers the meter with the store and reads back what a restart would lose: its last interval
  /// and its closed months.
  /// @param remember  Called with the intervals of the last 31 days; may be empty.
  /// @return the progress, or the store's failure.
  [[nodiscard]] static Result<MeterProgress> open(
      const metering::Meter& meter, const metering::LocalCalendar& calendar, Store& store,
      const std::function<void(const metering::Reading&)>& remember = {});

  /// Records a committed interval.
  void note(const metering::Reading& reading);

  /// As above, for an interval that was already stored.
  void recall(const metering::Reading& reading);

  /// Marks readings of closed months as late, and the months that depend on them as reopened.
  void mark_late(StoreBatch& batch, const metering::LocalCalendar& calendar) const;
};

}  // namespace recald::daemon
