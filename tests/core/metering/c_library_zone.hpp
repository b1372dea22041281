/// Local time by the C library, which reads the zone files with code of its own.
#pragma once

#include <time.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "core/metering/civil_time.hpp"

namespace recald::metering::testing {

/// The process's zone for the C library, put back afterwards.
class CLibraryZone {
 public:
  /// @param name  "Europe/Berlin", or a rule: "CET-1CEST,M3.5.0,M10.5.0/3"
  explicit CLibraryZone(const char* name) {
    if (const char* before = std::getenv("TZ")) before_ = before;
    setenv("TZ", name, 1);
    tzset();
  }
  ~CLibraryZone() {
    if (before_) {
      setenv("TZ", before_->c_str(), 1);
    } else {
      unsetenv("TZ");
    }
    tzset();
  }
  CLibraryZone(const CLibraryZone&) = delete;
  CLibraryZone& operator=(const CLibraryZone&) = delete;

  [[nodiscard]] static std::chrono::seconds utc_offset(Instant t) {
    const time_t since_1970 = t.time_since_epoch().count();
    tm local{};
    localtime_r(&since_1970, &local);
    return std::chrono::seconds{local.tm_gmtoff};
  }

 private:
  std::optional<std::string> before_;
};

}  // namespace recald::metering::testing
