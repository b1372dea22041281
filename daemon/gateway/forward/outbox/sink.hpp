/// Where intervals, months, events and results are sent: a broker, a database, a fleet's record, a
/// mail server or a webhook.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/record/record_batch.hpp"

namespace recald::daemon {

struct OutgoingBatch {
  std::vector<OutboxEntry> entries;
  std::vector<StoreEvent> events;
  std::vector<StoredJob> results;  ///< Finished jobs.
  record::Progress after = {};     ///< Where the destination is before it, in what it wants.
  bool is_history = false;  ///< Entries of `history_after`, which are numbered by themselves.
  /// Which numbering these positions are of (outbox_identity); 0: the destination has none.
  std::int64_t identity = 0;
  bool is_first = false;        ///< The destination has taken nothing of this numbering yet.
  metering::Instant time = {};  ///< When it was made.

  [[nodiscard]] std::size_t size() const { return entries.size() + events.size() + results.size(); }
};

struct Sent {
  enum class Outcome : std::uint8_t {
    taken,
    partly,   ///< Some of it was left out for good, and the rest taken.
    refused,  ///< Nothing was taken, and the same batch never will be: a part of it may be.
    later,    ///< Nothing is wrong with the batch.
    behind,   ///< The destination has less than `after`, which it had taken once.
  };
  Outcome outcome = Outcome::taken;
  std::string why = {};          ///< Unless taken: who said what.
  std::chrono::seconds wait{0};  ///< Of `later`: at least so long, as the other side asks.
  /// Where the destination is, if it says so: of `taken` and `behind`.
  std::optional<record::Progress> until = {};
};

class Sink {
 public:
  virtual ~Sink() = default;

  /// Sends a batch and waits until it was taken. A batch may come twice. An empty one asks whether
  /// anything would be taken. Runs on a thread of its own.
  [[nodiscard]] virtual Sent send(const OutgoingBatch& batch, const std::stop_token& stop) = 0;
};

}  // namespace recald::daemon
