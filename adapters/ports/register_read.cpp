#include "adapters/ports/register_read.hpp"

#include <cassert>

namespace recald::modbus {

std::string_view to_string(ReadFault fault) {
  switch (fault) {
    case ReadFault::timeout:
      return "timeout";
    case ReadFault::refused:
      return "refused";
    case ReadFault::closed:
      return "closed";
    case ReadFault::exception:
      return "exception";
    case ReadFault::mismatch:
      return "mismatch";
    case ReadFault::crc:
      return "crc";
  }
  assert(false && "every fault has a name");
  return "";
}

}  // namespace recald::modbus
