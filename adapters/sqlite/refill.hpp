/// Intervals that a store has lost, out of the samples of their register that it still has.
#pragma once

#include <cstdint>

#include "adapters/sqlite/sqlite_store.hpp"

namespace recald::sqlite {

struct Refilled {
  std::int64_t from_samples = 0;
  std::int64_t still_missing = 0;  ///< From the first to the last that there ever were.
};

/// Each meter's intervals follow each other without a gap, also where nothing was measured; so a
/// gap is a loss. The samples kept around each boundary say what the register counted in between.
[[nodiscard]] Result<Refilled> refill_intervals(SqliteStore& store);

}  // namespace recald::sqlite
