/// The body of POST /api/v1/readings, checked.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/metering/reading.hpp"
#include "core/metering/registers/fall_run.hpp"
#include "daemon/gateway/ingest/correction.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/site/config/weather_sensors.hpp"

namespace recald::daemon {

struct PushedReadings {
  const MeterConfig* meter;
  /// The quantity of a weather sensor, from its unit; null for a meter.
  const weather::SensorQuantity* quantity = nullptr;
  /// At least one; `meter` is 0. Values that the meter cannot have are `suspect`, with a reason.
  std::vector<metering::Reading> readings;
  /// Of a meter with a counter, in the place of readings; none if all values are null.
  std::vector<metering::RegisterSample> samples = {};
  std::optional<Correction> correction;  ///< Set if the readings correct stored ones.

  /// The id in the store: a meter's, or a channel's.
  [[nodiscard]] std::string stored_id() const;
};

/// @param body
/// {"meter":"chw","unit":"kWh","stamps":"start","readings":[{"time":"…Z","value":1.5}]};
///              `stamps` may be absent and is "start" then, a null value is a missing interval.
///              With `reason` (and `author`, default "api") it is a correction. Of a meter with a
///              counter the values are what its register read, at any time.
/// @param now   Intervals that end later have not happened yet.
/// @return the readings, or the response that refuses all of them: 400, 404 for an unknown meter,
///         409 for one whose readings come from elsewhere.
[[nodiscard]] Checked<PushedReadings> parse_pushed(std::string_view body, const SiteConfig& site,
                                                   metering::Instant now);

}  // namespace recald::daemon
