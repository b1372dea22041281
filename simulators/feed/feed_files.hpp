/// The text of a feed: readings, weather, the user's site file, and the truth for scoring.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "simulators/feed/meters.hpp"

namespace recald::simulators {

/// `timestamp,meter,value,unit`, start stamps in UTC, ordered by time, then meter.
[[nodiscard]] std::string readings_csv(const Recording& recording,
                                       const std::array<MeterFeed, kMeters>& feeds);

/// `timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2`, start stamps.
[[nodiscard]] std::string weather_csv(const Recording& recording, const WeatherFeed& feed);

/// What an engineer with the drawings would write. Depends on the period alone, never on the seed.
[[nodiscard]] std::string site_toml(const Period& period);

/// Everything the site file hides, as JSON: the true parameters with notes on their meaning, the
/// faults that were injected, and clean monthly figures by local month.
[[nodiscard]] Result<std::string> truth_json(const Truth& truth, const Period& period,
                                             std::uint64_t seed, const Recording& recording,
                                             const std::array<MeterFeed, kMeters>& feeds,
                                             const WeatherFeed& weather);

}  // namespace recald::simulators
