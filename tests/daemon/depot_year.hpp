/// The depot's 2021 on disk, or some months more: a plain year's temperatures, heat that follows
/// them, lights by day.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "core/metering/civil_time.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

inline constexpr int kDepotYear_h = 8760;

inline constexpr metering::Instant kDepotBegin =
    std::chrono::sys_days{std::chrono::year{2020} / 12 / 31} + std::chrono::hours{23};

/// Writes readings.csv, weather.csv and site.toml. @param begin  Of its first year, in UTC.
inline void write_depot_year(const std::filesystem::path& folder,
                             const std::string& site = sample_site(), int hours = kDepotYear_h,
                             metering::Instant begin = kDepotBegin) {
  std::string readings = "timestamp,meter,value,unit\n";
  std::string weather =
      "timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2\n";
  for (int h = 0; h < hours; ++h) {
    const std::string stamp = metering::to_string(begin + std::chrono::hours{h});
    const double day = h / 24.0;
    const double sun =
        std::max(0.0, -std::cos(h * 0.2618)) * (350.0 - 250.0 * std::cos(day * 0.01721));
    const double dry_bulb = 9.5 - 10.0 * std::cos((day - 20.0) * 0.01721) +
                            3.0 * std::sin(day * 0.7) - 3.0 * std::cos((h - 3) * 0.2618);
    const bool open = h % 24 >= 7 && h % 24 < 19;
    // No two hours alike: a meter that stands still is not believed.
    const double wiggle = std::sin(1.3 * h);
    readings += stamp + ",electricity," + std::to_string((open ? 52.0 : 11.0) + wiggle) + ",kW\n";
    readings += stamp + ",heat," +
                std::to_string(std::max(2.0, 5.2 * (15.5 - dry_bulb)) + 0.3 * wiggle) + ",kWh\n";
    weather += stamp + "," + std::to_string(dry_bulb) + "," +
               std::to_string(72.0 + 12.0 * std::cos(day * 0.31)) + "," +
               std::to_string(2.5 + std::sin(day * 0.23)) + "," +
               std::to_string(std::fmod(180.0 + 90.0 * std::sin(day * 0.11), 360.0)) + "," +
               std::to_string(sun) + "\n";
  }
  write_text(folder / "readings.csv", readings);
  write_text(folder / "weather.csv", weather);
  write_text(folder / "site.toml", site);
}

}  // namespace recald::testing
