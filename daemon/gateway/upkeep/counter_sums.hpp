/// Intervals held against the counter that they came from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"

namespace recald::daemon {

struct CounterComparison {
  std::uint64_t days = 0;  ///< That could be compared.
  std::vector<std::string> problems;
};

/// Compares the sum of each UTC day's intervals with the difference of the register's samples. The
/// register at midnight lies between the samples around it, five minutes apart at most; days in
/// which the register was reset, or that a person edited, are left out.
[[nodiscard]] Result<CounterComparison> compare_with_counter(Store& store,
                                                             const StoredMeter& meter);

}  // namespace recald::daemon
