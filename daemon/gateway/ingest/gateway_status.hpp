/// The gateway's status for people: meters, buses, data waiting for the store.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/metering/reading.hpp"
#include "daemon/gateway/ingest/committer.hpp"
#include "daemon/gateway/ingest/meter_progress.hpp"
#include "daemon/gateway/ingest/meter_track.hpp"
#include "daemon/gateway/ingest/refusal_watch.hpp"
#include "daemon/gateway/ingest/sensor_watch.hpp"
#include "daemon/gateway/poll/bus_counters.hpp"
#include "daemon/gateway/poll/latency_histogram.hpp"
#include "daemon/gateway/poll/unit_health.hpp"

namespace recald::daemon {

/// The status of a polled meter.
struct PollStatus {
  std::string bus;
  UnitState state = UnitState::up;
  std::uint64_t skipped = 0;
  RequestCounts requests{};
  std::vector<RefusedRegisters> refused;  ///< Currently.
};

/// One quantity of a weather sensor.
struct QuantityStatus {
  const weather::SensorQuantity* quantity;
  std::optional<double> now;                       ///< In its unit; for a polled sensor.
  std::optional<metering::Reading> last_interval;  ///< Committed.
  std::optional<metering::Instant> known_until;    ///< End of the last valid interval.
  double open_month_coverage = 0.0;                ///< As in MeterStatus.
  ChannelState state;
};

/// The status of one meter or weather sensor with stored readings.
struct MeterStatus {
  std::string id;
  std::optional<PollStatus> poll;  ///< Absent: its readings are pushed, or come from a broker.
  LiveValues live;                 ///< For a pushed meter, only when it was last heard from.
  std::optional<metering::Reading> last_interval;  ///< Committed.
  MeterCounters counters;
  double open_month_coverage = 0.0;  ///< 0…1; NaN before the month's first interval has ended.
  /// For a weather sensor; its counters are then the sum and its coverage the least of these.
  std::vector<QuantityStatus> weather = {};
};

struct BusStatus {
  std::string name;
  LatencyHistogram duration;
  LatencyHistogram lateness;
};

/// A destination outside that receives each interval and month.
struct DestinationStatus {
  std::string name;          ///< For people: "Prometheus at metrics.example.org".
  std::int64_t waiting = 0;  ///< Entries of the outbox that it has not had yet.
  std::string why = {};      ///< Why the last ones could not be sent; empty: nothing is wrong.
  std::optional<metering::Instant> sent_at = {};  ///< It last took some; nothing: not yet.
};

struct GatewayStatus {
  bool clock_ok = false;
  std::string clock_doubt = {};  ///< Why it is not.
  CommitHealth store;
  std::string no_store;  ///< Why readings are only kept in memory; empty: they are not.
  std::size_t waiting_intervals = 0;      ///< Waiting for the store.
  std::array<std::uint64_t, 3> events{};  ///< Committed, by Severity.
  std::vector<BusStatus> buses;           ///< Buses that have meters.
  std::vector<MeterStatus> meters;
  std::vector<DestinationStatus> destinations = {};
};

}  // namespace recald::daemon
