/// Points as Prometheus remote write 1.0 sends them: a protobuf message, compressed with Snappy.
///
/// https://prometheus.io/docs/specs/remote_write_spec
///
/// Prometheus itself (2.42) takes them with `--web.enable-remote-write-receiver`, all points of a
/// message or none. What it thinks of old ones depends on the newest sample that it has of
/// anything:
/// - More than an hour before that it refuses all, unless `storage.tsdb.out_of_order_time_window`
///   in its configuration reaches back so far. Months, and an outbox after an outage, need it.
/// - A sample of the future makes it refuse what is written at present: forecasts are not for it.
/// - A sample stays what it was. Another value for the same time is refused, or, where it is not
/// the
///   newest of its series, taken and perhaps not stored.
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
