#include "daemon/commands/generated_at.hpp"

#include <chrono>
#include <cstdlib>

#include "core/metering/civil_time.hpp"

namespace recald::daemon {

std::string generated_at() {
  if (const char* fixed = std::getenv("SOURCE_DATE_EPOCH")) {
    return metering::to_string(metering::Instant{std::chrono::seconds{std::atoll(fixed)}});
  }
  return metering::to_string(
      std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()));
}

}  // namespace recald::daemon
