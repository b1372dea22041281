/// Charts of what meters read.
#pragma once

#include <cstdint>

#include "adapters/views/frame/html.hpp"
#include "core/weather/sensor_quantities.hpp"
#include "daemon/gateway/serve/api/served.hpp"

namespace recald::daemon {

enum class ChartKind : std::uint8_t { still, zoomable };

/// The history of a meter, or a sentence why there is none.
/// @param meter     As stored.
/// @param quantity  Of a weather sensor; null: power.
void write_meter_chart(views::Html& html, const Served& served, const metering::Meter& meter,
                       const weather::SensorQuantity* quantity, const metering::TimeSpan& span,
                       ChartKind kind);

/// The same beside what the model expects of its hours.
void write_expected_chart(views::Html& html, const Served& served, const metering::Meter& meter,
                          const ExpectedMeter& expected, const metering::TimeSpan& span);

}  // namespace recald::daemon
