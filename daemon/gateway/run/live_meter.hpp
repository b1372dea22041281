/// A meter or weather sensor whose registers come in one after the other, with its counters.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/meter_progress.hpp"
#include "daemon/gateway/ingest/meter_track.hpp"
#include "daemon/gateway/ingest/weather_track.hpp"
#include "daemon/gateway/poll/bus_runner.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// A meter or a weather sensor.
struct LiveMeter {
  std::string id;
  std::vector<MeterProgress> progress;  ///< One for a meter, or one per quantity of a sensor.
  LiveMeterConfig config;
  std::string text;  ///< As in MeterConfig.
  std::variant<MeterTrack, WeatherTrack> track;
  std::vector<modbus::PlannedRead> reads;
  std::string doubt = {};  ///< What was wrong with its stored state; empty: nothing.

  [[nodiscard]] StoreBatch take(const PolledRead& read, metering::Instant at);
  void clock_was_set();
  [[nodiscard]] std::vector<RefusedRegisters> refused() const;
  [[nodiscard]] std::chrono::seconds interval() const {
    return progress.front().stored.meter.interval;
  }
};

/// Registers a meter with the store and restores its counters.
/// @param live  What its registers are: of a meter that is polled its `live`.
/// @return the meter, or the store's failure; unsupported if its reads cannot be planned.
[[nodiscard]] Result<LiveMeter> open_live_meter(const MeterConfig& config,
                                                const LiveMeterConfig& live,
                                                const metering::LocalCalendar& calendar,
                                                Store& store);

/// The same of a weather sensor that is polled.
[[nodiscard]] Result<LiveMeter> open_live_sensor(const MeterConfig& config,
                                                 const metering::LocalCalendar& calendar,
                                                 Store& store);

}  // namespace recald::daemon
