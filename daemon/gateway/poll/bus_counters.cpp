#include "daemon/gateway/poll/bus_counters.hpp"

#include <cassert>

namespace recald::daemon {

RequestResult result_of(const modbus::ReadResult& result) {
  if (result) return RequestResult::ok;
  switch (result.error().fault) {
    case modbus::ReadFault::timeout:
    case modbus::ReadFault::refused:
    case modbus::ReadFault::closed:
      return RequestResult::timeout;
    case modbus::ReadFault::exception:
      return RequestResult::exception;
    case modbus::ReadFault::mismatch:
      return RequestResult::mismatch;
    case modbus::ReadFault::crc:
      return RequestResult::crc;
  }
  assert(false && "every fault is counted");
  return RequestResult::timeout;
}

}  // namespace recald::daemon
