#include "daemon/gateway/feed/mqtt_feed.hpp"

#include <algorithm>

namespace recald::daemon {

using metering::Instant;

Result<std::unique_ptr<MqttFeed>> MqttFeed::open(const MeterConfig& config,
                                                 const metering::LocalCalendar& calendar,
                                                 Store& store) {
  const LiveMeterConfig live{.map = config.mqtt->map, .poll = config.mqtt->every};
  return std::unique_ptr<MqttFeed>{
      new MqttFeed{TRY(open_meter_registers(config, live, calendar, store))}};
}

std::optional<PolledRead> MqttFeed::read_of(const MeterValue& value, const Moment& now) const {
  const modbus::RegisterMap& map = config().map;
  const auto read = std::ranges::find_if(reads(), [&](const modbus::PlannedRead& one) {
    const std::string field = metered_fields(map)[one.fields.front()].name;
    return value.is_counter ? field == map.energy.front() : map.power == field;
  });
  if (read == reads().end()) return std::nullopt;
  return PolledRead{.order = {.unit = 0,
                              .read = static_cast<std::size_t>(read - reads().begin()),
                              .request = {},
                              .timeout = {},
                              .due = value.measured ? WallTime{*value.measured} : now.wall,
                              .is_probe = false},
                    .result = modbus::float64_words(value.value),
                    .lateness = {},
                    .duration = {},
                    .at = now};
}

bool MqttFeed::is_late(const MeterValue& value, Instant at) const {
  const bool makes_intervals = value.is_counter || config().map.energy.empty();
  return makes_intervals ? at <= meter().last_sample().value_or(Instant::min())
                         : at < meter().live().read_at.value_or(Instant::min());
}

MeterStatus MqttFeed::status(Instant now) const {
  MeterStatus status = RegisterFeed::status(now);
  // Nobody says that a power has gone out of date.
  const auto read_at = status.live.read_at;
  if (!read_at || now - *read_at > 2 * config().poll) status.live.power_kW.reset();
  return status;
}

}  // namespace recald::daemon
