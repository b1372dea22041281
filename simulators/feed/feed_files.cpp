#include "simulators/feed/feed_files.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

namespace recald::simulators {
namespace {

/// ISO 8601 with Z; written by hand because a three-year feed has 400,000 of them.
void append_stamp(fmt::memory_buffer& out, metering::Instant t) {
  const auto day = std::chrono::floor<std::chrono::days>(t);
  const std::chrono::year_month_day date{day};
  const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(t - day).count();
  fmt::format_to(std::back_inserter(out), FMT_COMPILE("{:04}-{:02}-{:02}T{:02}:{:02}:00Z"),
                 static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                 static_cast<unsigned>(date.day()), minutes / 60, minutes % 60);
}

void append_text(fmt::memory_buffer& out, std::string_view text) {
  out.append(text.data(), text.data() + text.size());
}

}  // namespace

std::string readings_csv(const Recording& recording, const std::vector<MeterFeed>& feeds) {
  fmt::memory_buffer out;
  append_text(out, "timestamp,meter,value,unit\n");
  for (std::size_t slot = 0; slot < recording.power.size(); ++slot) {
    for (const MeterFeed& feed : feeds) {
      const Cell& cell = feed.cells[slot];
      if (cell.state == CellState::absent) continue;
      const MeterPlate& plate = feed.plate;
      append_stamp(out, recording.start_of(slot));
      fmt::format_to(std::back_inserter(out), FMT_COMPILE(",{},"), plate.id);
      if (cell.state == CellState::value) {
        fmt::format_to(std::back_inserter(out), FMT_COMPILE("{:.{}f}"), cell.value, plate.decimals);
      }
      fmt::format_to(std::back_inserter(out), FMT_COMPILE(",{}\n"), plate.unit);
    }
  }
  return fmt::to_string(out);
}

std::string footprint_csv(const Recording& recording, const std::vector<MeterPlate>& plates,
                          const std::vector<std::vector<double>>& footprint_kW) {
  fmt::memory_buffer out;
  append_text(out, "timestamp,meter,value,unit\n");
  for (std::size_t slot = 0; slot < recording.power.size(); ++slot) {
    for (std::size_t meter = 0; meter < plates.size(); ++meter) {
      append_stamp(out, recording.start_of(slot));
      fmt::format_to(std::back_inserter(out), FMT_COMPILE(",{},{:.3f},kW\n"), plates[meter].id,
                     footprint_kW[meter][slot]);
    }
  }
  return fmt::to_string(out);
}

std::string weather_csv(const Recording& recording, const WeatherFeed& feed) {
  fmt::memory_buffer out;
  append_text(out, "timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2\n");
  for (std::size_t slot = 0; slot < feed.cells.size(); ++slot) {
    const WeatherCell& cell = feed.cells[slot];
    if (cell.absent) continue;
    append_stamp(out, recording.start_of(slot));
    fmt::format_to(std::back_inserter(out), FMT_COMPILE(",{:.1f},"), cell.reading.dry_bulb_C);
    if (!cell.humidity_blank) {
      fmt::format_to(std::back_inserter(out), FMT_COMPILE("{:.1f}"),
                     100.0 * cell.reading.relative_humidity);
    }
    fmt::format_to(std::back_inserter(out), FMT_COMPILE(",{:.1f},{:.0f},{:.0f}\n"),
                   cell.reading.wind_speed_m_s, cell.reading.wind_from_deg,
                   cell.reading.global_horizontal_W_m2);
  }
  return fmt::to_string(out);
}

}  // namespace recald::simulators
