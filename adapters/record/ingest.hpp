/// Takes what gateways send into the record, and gives it back.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/postgres/connection.hpp"
#include "adapters/record/record_batch.hpp"
#include "core/result.hpp"

namespace recald::record {

/// Commits a batch in one transaction: what is above the outbox's watermark, the watermark itself,
/// and jobs for months that are complete now (channel `recald_job` is notified). A batch may come
/// twice, late, or to two workers at once. A new outbox of the site goes on after the last row,
/// whatever numbers it gives. Where the record has less than what the gateway took for told,
/// nothing is taken: the answer says so, and the gateway tells all of it again.
/// @param now  When it came.
/// @return the watermark after it, zeros for an outbox that the record does not know; not_found:
/// the site is not registered, or retired; io_failed: nothing
///         was taken as far as we know, try later.
[[nodiscard]] Result<Watermark> take(postgres::Connection& connection, const std::string& site,
                                     const RecordBatch& batch, metering::Instant now);

/// The newest outbox's watermark of each site; of outbox 0 where none has sent anything.
[[nodiscard]] Result<std::vector<std::pair<std::string, Watermark>>> watermarks(
    postgres::Connection& connection);

/// Copies what the record has of a site into an empty store: the last revision of each interval,
/// and all of each month, among the rows with seq <= until_seq. The same arguments give the same
/// store for ever. Not copied are closing rules, counters, events and jobs: a worker needs none.
[[nodiscard]] Result<void> copy_into(Store& store, postgres::Connection& connection,
                                     const std::string& site, std::int64_t until_seq);

}  // namespace recald::record
