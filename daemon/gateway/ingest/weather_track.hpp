/// One polled weather sensor: turns the contents of its registers into stored interval means.
///
/// Like `MeterTrack`, it does not know the bus or the store: it takes the outcome of each read and
/// returns what must be committed together. Its values are instantaneous; there is no counter.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adapters/modbus/register_map.hpp"
#include "adapters/ports/store.hpp"
#include "core/weather/sensor_quantities.hpp"
#include "daemon/gateway/ingest/refusal_watch.hpp"

namespace recald::daemon {

/// One quantity that a sensor measures.
struct TrackedQuantity {
  std::uint32_t number = 0;  ///< In the store.
  const weather::SensorQuantity* quantity = nullptr;
  std::vector<RegisterState> restored = {};  ///< The stored states; empty: never seen.
};

struct TrackedSensor {
  std::string id;
  modbus::RegisterMap map;  ///< Its `weather` registers are read.
  metering::PowerRules averaging;
  std::vector<TrackedQuantity> quantities;
};

class WeatherTrack {
 public:
  explicit WeatherTrack(TrackedSensor sensor);

  /// Takes the outcome of one read, planned over `modbus::metered_fields`. An impossible value
  /// counts as missing; an event reports it, at most once an hour.
  [[nodiscard]] StoreBatch take(const modbus::PlannedRead& read, const modbus::ReadResult& result,
                                metering::Instant at);

  /// The clock was set, so the weather in between belongs to no interval.
  void clock_was_set();

  /// The last value, in the quantity's unit; nothing if the last read had none.
  [[nodiscard]] std::optional<double> now(std::uint32_t number) const;
  [[nodiscard]] std::optional<metering::Instant> read_at() const { return read_at_; }
  [[nodiscard]] std::vector<RefusedRegisters> refused() const { return refusals_.refused(); }

 private:
  /// A quantity and the mean of its open interval; for a direction, those of east and north.
  struct Channel {
    std::uint32_t number;
    const weather::SensorQuantity* quantity;
    std::array<metering::PowerBook, 2> books{};
    metering::Reason since = metering::Reason::none;  ///< Why there has been no value since.
    std::optional<double> now = {};
    metering::Instant relived_until =
        metering::Instant::min();  ///< Latest stamp before the clock was set back.
    metering::Instant reported = metering::Instant::min();  ///< Of an impossible value.
  };

  [[nodiscard]] Channel* channel_of(const std::string& field);
  void take_value(StoreBatch& batch, Channel& channel, double value, metering::Instant at);
  void book(StoreBatch& batch, Channel& channel, double value, metering::Instant at) const;
  void notify(StoreBatch& batch, Channel& channel, double value, metering::Instant at) const;
  void put_states(StoreBatch& batch) const;

  std::string id_;
  std::vector<modbus::RegisterField> fields_;
  metering::PowerRules averaging_;
  std::vector<Channel> channels_;
  RefusalWatch refusals_;
  std::optional<metering::Instant> read_at_;  ///< Time of the last good read.
  metering::Instant kept_{};                  ///< When the open intervals were last stored.
};

}  // namespace recald::daemon
