/// Rebuilds lost intervals of a store from the samples of their register that it still has.
#pragma once

#include <cstdint>

#include "adapters/sqlite/sqlite_store.hpp"

namespace recald::sqlite {

struct Refilled {
  std::int64_t from_samples = 0;
  std::int64_t still_missing = 0;  ///< Between the first and the last that ever existed.
};

/// Each meter's intervals follow each other without gaps, even when nothing was measured, so a gap
/// is a loss. The samples around each boundary show what the register counted in between.
[[nodiscard]] Result<Refilled> refill_intervals(SqliteStore& store);

}  // namespace recald::sqlite
