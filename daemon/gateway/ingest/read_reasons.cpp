#include "daemon/gateway/ingest/read_reasons.hpp"

#include <cassert>

namespace recald::daemon {

using metering::Reason;

Reason reason_of(const modbus::ReadFailure& failure) {
  switch (failure.fault) {
    case modbus::ReadFault::timeout:
    case modbus::ReadFault::refused:
    case modbus::ReadFault::closed:
      return Reason::timeout;
    case modbus::ReadFault::exception:
      return Reason::exception;
    case modbus::ReadFault::mismatch:
      return Reason::mismatch;
    case modbus::ReadFault::crc:
      return Reason::crc;
  }
  assert(false && "every fault has a reason");
  return Reason::none;
}

Reason reason_of(modbus::ValueFault fault) {
  return fault == modbus::ValueFault::absent ? Reason::sentinel : Reason::nan;
}

}  // namespace recald::daemon
