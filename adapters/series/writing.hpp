/// Sends points to a database of time series, and says what its answer means for an outbox.
#pragma once

#include <chrono>
#include <span>
#include <string>

#include "adapters/delivery/delivery.hpp"
#include "adapters/series/point.hpp"

namespace recald::series {

enum class Protocol {
  remote_write,  ///< Prometheus and what takes its protocol: Mimir, VictoriaMetrics, Thanos.
  influx,        ///< InfluxDB 1.x `/write`, or what takes line protocol in nanoseconds.
};

/// @param to  Address and credentials. @return it with what the protocol adds: body and headers.
[[nodiscard]] delivery::Post message(Protocol protocol, delivery::Post to,
                                     std::span<const Point> points);

enum class Outcome {
  taken,    ///< All of it.
  partly,   ///< InfluxDB left points out for good and took the others. To send it again is useless.
  refused,  ///< Nothing was taken, and the same message will never be: a part of it may be.
  later,    ///< Nothing is wrong with the message: send it again.
};

struct Meaning {
  Outcome outcome;
  /// Of `later`: at least this long, as the server asks; 0: it does not say.
  std::chrono::seconds wait{0};
  std::string why;  ///< A sentence's part, unless taken: "answered with status 404: database not…".
};

/// What the outbox should do with the message that was answered so.
///
/// A server refuses a message because of what is in it (400, 413, 422). Some also answer like that
/// where the address is wrong. So before a single refused point is set aside, send a message of no
/// points: where that is `taken`, the point is at fault, otherwise the destination is.
[[nodiscard]] Meaning meaning_of(const delivery::Answer& answer);

}  // namespace recald::series
