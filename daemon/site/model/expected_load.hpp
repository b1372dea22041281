/// What a model expects meters to read.
#pragma once

#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/profile/load_band.hpp"

namespace recald::daemon {

struct ExpectedHour {
  metering::Instant start;
  profile::ExpectedLoad load;
};

struct ExpectedMeter {
  std::string meter;                ///< Its id, one of the model's outputs.
  std::vector<ExpectedHour> hours;  ///< In order of time; one without a band is left out.
};

}  // namespace recald::daemon
