/// Statistics of a bus since the process started.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "daemon/gateway/poll/bus_poller.hpp"
#include "daemon/gateway/poll/latency_histogram.hpp"

namespace recald::daemon {

/// How a request ended. A missing or closed connection counts as a timeout, as in an
/// interval's reasons.
enum class RequestResult : std::uint8_t { ok, timeout, exception, crc, mismatch };

inline constexpr std::array<std::string_view, 5> kRequestResults{"ok", "timeout", "exception",
                                                                 "crc", "mismatch"};

using RequestCounts = std::array<std::uint64_t, kRequestResults.size()>;  ///< By RequestResult.

[[nodiscard]] RequestResult result_of(const modbus::ReadResult& result);

struct BusCounters {
  std::vector<RequestCounts> requests;  ///< By unit.
  LatencyHistogram duration;            ///< Of all requests, from request to outcome.
  /// Delay of each poll's first request after its due time; probes have no due time.
  LatencyHistogram lateness;
};

}  // namespace recald::daemon
