/// Files that accompany a scenario's feed: the user's site file, and the truth for scoring.
#pragma once

#include <cstdint>
#include <string>

#include "simulators/scenario/twin.hpp"

namespace recald::simulators {

/// What an engineer with the drawings would write. Depends on drawings, period and the existing
/// meters, never on the seed or on hidden effects.
[[nodiscard]] std::string site_toml(const Scenario& scenario);

/// Everything that the site file does not show, as JSON: the true parameters with notes on their
/// meaning, the injected faults, the effects, and clean monthly figures by local month.
[[nodiscard]] std::string truth_json(const Scenario& scenario, std::uint64_t seed,
                                     const Simulated& simulated,
                                     const std::vector<MeterFeed>& feeds,
                                     const WeatherFeed& weather,
                                     const metering::LocalCalendar& calendar);

}  // namespace recald::simulators
