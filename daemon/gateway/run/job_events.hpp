/// What a finished job has to say to people who do not look at it.
#pragma once

#include <optional>
#include <vector>

#include "adapters/ports/store.hpp"

namespace recald::daemon {

/// Events of a job that has just ended: it failed, its checks did not pass, something was named,
/// the months show an alarm that the calibration in use until now did not have.
/// @param before  The last calibration that followed the months, with its result.
[[nodiscard]] std::vector<StoreEvent> events_of(const StoredJob& job, bool has_named,
                                                const std::optional<StoredJob>& before);

}  // namespace recald::daemon
