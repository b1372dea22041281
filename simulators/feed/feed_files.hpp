/// The text of a feed: readings, weather, and the additions of effects.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulators/feed/meters.hpp"

namespace recald::simulators {

/// `timestamp,meter,value,unit`, start stamps in UTC, ordered by time, then meter.
[[nodiscard]] std::string readings_csv(const Recording& recording,
                                       const std::vector<MeterFeed>& feeds);

/// `timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2`, start stamps.
[[nodiscard]] std::string weather_csv(const Recording& recording, const WeatherFeed& feed);

/// Writes `footprint_kW` (by meter, then interval) in the format of readings:
/// `timestamp,meter,value,unit`, kW.
[[nodiscard]] std::string footprint_csv(const Recording& recording,
                                        const std::vector<MeterPlate>& plates,
                                        const std::vector<std::vector<double>>& footprint_kW);

}  // namespace recald::simulators
