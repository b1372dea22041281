/// What a bus has done since the process began, counted for those who watch it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "daemon/gateway/poll/bus_poller.hpp"
#include "daemon/gateway/poll/latency_histogram.hpp"

namespace recald::daemon {

/// How a request ended. No connection and a closed one are a timeout too, as in an interval's
/// reasons.
enum class RequestResult : std::uint8_t { ok, timeout, exception, crc, mismatch };

inline constexpr std::array<std::string_view, 5> kRequestResults{"ok", "timeout", "exception",
                                                                 "crc", "mismatch"};

using RequestCounts = std::array<std::uint64_t, kRequestResults.size()>;  ///< By RequestResult.

[[nodiscard]] RequestResult result_of(const modbus::ReadResult& result);

struct BusCounters {
  std::vector<RequestCounts> requests;  ///< By unit.
  LatencyHistogram duration;            ///< Of all requests, from request to outcome.
  /// Of each poll's first request behind its due time; probes are not due at any time.
  LatencyHistogram lateness;
};

}  // namespace recald::daemon
