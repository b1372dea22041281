/// The body of POST /api/v1/readings, checked.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/metering/reading.hpp"
#include "daemon/gateway/ingest/correction.hpp"
#include "daemon/gateway/serve/parameters.hpp"
#include "daemon/site/config/weather_sensors.hpp"

namespace recald::daemon {

struct PushedReadings {
  const MeterConfig* meter;
  /// What a weather sensor has sent, as its unit says; null for a meter.
  const weather::SensorQuantity* quantity = nullptr;
  /// At least one; `meter` is 0. What the meter cannot read is `suspect`, with its reason.
  std::vector<metering::Reading> readings;
  std::optional<Correction> correction;  ///< Corrects what is stored.

  /// Under which the store keeps them: a meter's, or a channel's.
  [[nodiscard]] std::string stored_id() const;
};

/// @param body
/// {"meter":"chw","unit":"kWh","stamps":"start","readings":[{"time":"…Z","value":1.5}]};
///              `stamps` may be absent and is "start" then, a null value is a missing interval.
///              With `reason` (and `author`, "api" where absent) it is a correction.
/// @param now   What ends after it has not happened yet.
/// @return or the answer that refuses all of it: 400, 404 for another meter, 409 for one whose
///         readings come from elsewhere.
[[nodiscard]] Checked<PushedReadings> parse_pushed(std::string_view body, const SiteConfig& site,
                                                   metering::Instant now);

}  // namespace recald::daemon
