/// Simulates a scenario's building, with and without its hidden effects.
#pragma once

#include "simulators/scenario/scenario.hpp"

namespace recald::simulators {

struct Simulated {
  Building building;  ///< In its state at the end of the period.
  Recording recording;
};

/// @return not_found if the system has no zone files.
/// @pre the scenario's effects were checked
[[nodiscard]] Result<Simulated> simulate(const Scenario& scenario, std::uint64_t seed,
                                         const metering::LocalCalendar& calendar);

/// The same building, weather, people and meters, without hidden effects.
[[nodiscard]] Scenario twin_of(Scenario scenario);

/// What the effects add to each meter of `plates_of`, kW by interval, free of noise and gaps.
/// @pre both were simulated from the same scenario and seed
[[nodiscard]] std::vector<std::vector<double>> footprint_kW(
    const Simulated& with, const Simulated& without, const metering::LocalCalendar& calendar);

/// Meters and weather station of a simulated scenario, decoys included.
struct Feeds {
  std::vector<MeterFeed> meters;
  WeatherFeed weather;
};
[[nodiscard]] Feeds read_feeds(const Scenario& scenario, std::uint64_t seed,
                               const Simulated& simulated, const metering::LocalCalendar& calendar);

}  // namespace recald::simulators
