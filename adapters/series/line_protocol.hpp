/// Points as InfluxDB's line protocol.
///
/// https://docs.influxdata.com/influxdb/v1/write_protocols/line_protocol_reference
#pragma once

#include <span>
#include <string>

#include "adapters/series/point.hpp"

namespace recald::series {

/// A line for each point that has a finite field. Times are nanoseconds, InfluxDB's own unit: it
/// would read seconds as times in 1970, and store them, wherever `precision` is missing.
///
/// A label's value cannot hold a line break there, nor a backslash at its end or before a character
/// that is escaped. So in any value a backslash becomes "/", a control character a space.
/// @return a body for `POST /write?db=…`. That of no points is valid: the server takes it and
///         stores nothing.
[[nodiscard]] std::string line_protocol(std::span<const Point> points);

}  // namespace recald::series
