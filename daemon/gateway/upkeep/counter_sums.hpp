/// Compares intervals with the counter that they came from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adapters/ports/interval_store.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"

namespace recald::daemon {

struct CounterComparison {
  std::uint64_t days = 0;  ///< Days that could be compared.
  std::vector<std::string> problems;
};

/// Compares the sum of each UTC day's intervals with the difference of the register's samples. The
/// register at midnight is interpolated between the samples around it, at most five minutes apart.
/// Days with a reset of the register or a manual edit are left out.
[[nodiscard]] Result<CounterComparison> compare_with_counter(IntervalStore& store,
                                                             const StoredMeter& meter);

}  // namespace recald::daemon
