/// What destinations outside have still to be sent of intervals and months.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "adapters/ports/interval_store.hpp"
#include "adapters/ports/month_store.hpp"
#include "core/result.hpp"

namespace recald {

/// One change that destinations outside are told: an interval or a month as it was stored then.
struct OutboxEntry {
  std::int64_t number = 0;  ///< 1, 2, 3 …; none is given twice.
  std::string meter;        ///< Its id.
  std::chrono::seconds interval{};
  /// Nothing for what damage took.
  std::variant<std::monostate, StoredInterval, StoredMonth> stored;
};

/// The cursor over the events (Store::cursor) of a destination that has them beside the outbox.
[[nodiscard]] inline std::string events_cursor(const std::string& destination) {
  return "events of " + destination;
}

/// How far a destination has been told.
struct OutboxPosition {
  std::int64_t sent;  ///< Number of the last entry that it has had.
  std::int64_t last;  ///< Number of the last entry of all.
};

class OutboxStore {
 public:
  virtual ~OutboxStore() = default;

  /// Sets which destinations are told of each interval and month that is stored from now on; until
  /// then, of none. Those that were set before keep their positions, others lose theirs. What
  /// everyone has been told is forgotten.
  virtual Result<void> keep_outbox_for(const std::vector<std::string>& destinations) = 0;

  /// Entries with a greater number, in order of their numbers.
  virtual Result<std::vector<OutboxEntry>> outbox_after(std::int64_t number, int limit) = 0;

  virtual Result<OutboxPosition> outbox_position(const std::string& destination) = 0;

  /// The destination has had all entries up to this number.
  virtual Result<void> put_outbox_position(const std::string& destination, std::int64_t number) = 0;
};

}  // namespace recald
