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

/// Counts for a meter since the process began.
struct MeterCounters {
  std::array<std::uint64_t, 5> intervals{};     ///< Committed, by Validity.
  std::uint64_t late = 0;                       ///< Of them, of months that were closed.
  std::map<std::string, std::uint64_t> events;  ///< By kind.
};

struct MeterProgress {
  StoredMeter stored;
  /// Of a quantity of a weather sensor; absent: a meter, whose months close.
  std::optional<WeatherChannel> channel = {};
  OpenMonth open_month;
  MeterCounters counters{};
  std::optional<metering::Reading> last_interval = {};        ///< Committed.
  metering::Instant closed_until = metering::Instant::min();  ///< End of the last closed month.
  /// The latest run of valid intervals, without a hole, that have the same value.
  std::optional<metering::TimeSpan> same_value = {};
  double same_value_is = 0.0;

  /// End of the latest valid interval; nothing before the first one, or if there was none for a
  /// month.
  [[nodiscard]] std::optional<metering::Instant> known_until() const {
    return same_value ? std::optional{same_value->end} : std::nullopt;
  }

  /// Registers the meter with the store and looks up what a restart would otherwise forget: its
  /// last interval and its closed months.
  /// @param remember  Is shown the intervals of the last 31 days; may be empty.
  /// @return or the store's failure.
  [[nodiscard]] static Result<MeterProgress> open(
      const metering::Meter& meter, const metering::LocalCalendar& calendar, Store& store,
      const std::function<void(const metering::Reading&)>& remember = {});

  /// An interval was committed.
  void note(const metering::Reading& reading);

  /// The same of one that the store had already.
  void recall(const metering::Reading& reading);

  /// Marks what belongs to a closed month as late; months that depend on it are to be closed again.
  void mark_late(StoreBatch& batch, const metering::LocalCalendar& calendar) const;
};

}  // namespace recald::daemon
