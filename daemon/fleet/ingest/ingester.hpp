/// Takes what gateways send through a broker into the record of the fleet, and tells them what they
/// may forget.
///
/// The record's word counts, never the broker's: a gateway is answered after the commit, and again
/// whenever the broker or the record was away. So the broker needs no memory, and several ingesters
/// may share the work.
#pragma once

#include <cstdint>
#include <stop_token>

#include "daemon/fleet/config/fleet_config.hpp"
#include "daemon/fleet/config/keep_trying.hpp"

namespace recald::daemon {

struct IngestCounts {
  std::int64_t batches = 0;  ///< Committed, those that came again included.
  std::int64_t entries = 0;  ///< Intervals and months in them.
  /// Batches that cannot be taken: of unknown sites, of more than the record has, or no batches.
  std::int64_t refused = 0;
};

/// Takes batches until a stop is requested. While the record is away it leaves the broker and tries
/// again, 5 s to 60 s apart.
/// @param report  Gets a sentence about each change, and about each site whose batches are refused,
///              at most once in ten minutes.
[[nodiscard]] IngestCounts ingest(const RecordConfig& record, const BrokerConfig& broker,
                                  const Report& report, const std::stop_token& stop);

}  // namespace recald::daemon
