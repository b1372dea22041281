/// What a store had before its first destination, as entries like those of its outbox.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"

namespace recald::daemon {

struct MeterInStore {
  std::string id;
  std::chrono::seconds interval;
};

/// The next intervals, a meter after the other and in order of time within it, each followed by its
/// months; the latest revision of each. Their numbers say where they are, so they mean the same
/// whatever is stored meanwhile, and rise.
/// @param meters  Those that the store does not have are passed over.
/// @param after   Number of the last one that was sent; 0: none.
/// @return at most `limit`; empty: there are no more.
[[nodiscard]] Result<std::vector<OutboxEntry>> history_after(
    Store& store, const std::vector<MeterInStore>& meters, std::int64_t after, int limit);

}  // namespace recald::daemon
