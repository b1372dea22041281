/// The reason for a hole in an interval, from the outcome of a read.
#pragma once

#include "adapters/modbus/register_value.hpp"
#include "adapters/ports/register_read.hpp"
#include "core/metering/reading.hpp"

namespace recald::daemon {

[[nodiscard]] metering::Reason reason_of(const modbus::ReadFailure& failure);
[[nodiscard]] metering::Reason reason_of(modbus::ValueFault fault);

}  // namespace recald::daemon
