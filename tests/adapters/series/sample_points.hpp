/// Points of meters that a building could have.
#pragma once

#include <string>

#include "adapters/series/point.hpp"

namespace recald::testing {

/// Fields may be added.
inline series::Point interval_point(const std::string& meter, metering::Instant start,
                                    double mean_kW) {
  return {.measurement = "recald_interval",
          .labels = {{"site", "depot"}, {"meter", meter}},
          .time = start,
          .fields = {{"mean_kilowatts", mean_kW}}};
}

/// The last quarter of an hour that has begun.
inline metering::Instant this_quarter() {
  using std::chrono::system_clock;
  return metering::interval_start(std::chrono::floor<std::chrono::seconds>(system_clock::now()),
                                  std::chrono::minutes{15});
}

}  // namespace recald::testing
