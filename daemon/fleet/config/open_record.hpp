/// The record that a fleet's file names.
#pragma once

#include <memory>

#include "adapters/postgres/connection.hpp"
#include "daemon/fleet/config/fleet_config.hpp"

namespace recald::daemon {

/// Connects, with the password as it is in its file now. The schema is not looked at.
/// @return io_failed: it cannot be reached, or the password cannot be read.
[[nodiscard]] Result<std::unique_ptr<postgres::Connection>> open_record(
    const RecordConfig& config, const postgres::Patience& patience = {});

}  // namespace recald::daemon
