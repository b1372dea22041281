/// Points as Prometheus remote write 1.0 sends them: a protobuf message, compressed with Snappy.
///
/// https://prometheus.io/docs/specs/remote_write_spec
#pragma once

#include <span>
#include <string>

#include "adapters/series/point.hpp"

namespace recald::series {

/// A series for each field: its metric is the measurement, "_" and the field's name. Labels are
/// sorted by name, the samples of a series by time; of several at one time the last counts.
/// @return a body for `POST …/api/v1/write`. That of no points is valid: the server takes it and
///         stores nothing.
[[nodiscard]] std::string remote_write_body(std::span<const Point> points);

}  // namespace recald::series
