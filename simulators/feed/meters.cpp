#include "simulators/feed/meters.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr double kTon_kW = 3.516853;
constexpr double kBtuPerQuarterHour_kW = 4.0 * 0.29307107;

constexpr std::array<MeterPlate, kMeters> kPlates{{
    {.id = "chilled_water",
     .unit = "ton",
     .unit_kW = kTon_kW,
     .resolution = 0.1,
     .decimals = 1,
     .noise_share = 0.008,
     .noise_floor = 0.15,
     .gain_error_share = 0.005,
     .counts = false,
     .spike_min = 1000.0,
     .spike_max = 7000.0,
     .in_steam_pit = false},
    {.id = "electricity",
     .unit = "kW",
     .unit_kW = 1.0,
     .resolution = 0.5,
     .decimals = 1,
     .noise_share = 0.005,
     .noise_floor = 0.3,
     .gain_error_share = 0.003,
     .counts = true,
     .spike_min = 1300.0,
     .spike_max = 9000.0,
     .in_steam_pit = false},
    {.id = "steam",
     .unit = "kBtu",
     .unit_kW = kBtuPerQuarterHour_kW,
     .resolution = 1.0,
     .decimals = 0,
     .noise_share = 0.03,
     .noise_floor = 2.0,
     .gain_error_share = 0.01,
     .counts = true,
     .spike_min = 4000.0,
     .spike_max = 60'000.0,
     .in_steam_pit = true},
}};

/// Turns true power into what the display shows, without faults.
class Register {
 public:
  Register(const MeterPlate& plate, Rng& rng) : plate_(plate), rng_(rng) {}

  double read(double power_kW, double gain) {
    const double exact = power_kW / plate_.unit_kW;
    const double noisy = gain * exact * (1.0 + plate_.noise_share * rng_.normal()) +
                         plate_.noise_floor * rng_.normal() + remainder_;
    const double shown = std::max(0.0, std::round(noisy / plate_.resolution) * plate_.resolution);
    remainder_ = plate_.counts ? noisy - shown : 0.0;
    return shown;
  }

 private:
  const MeterPlate& plate_;
  Rng& rng_;
  double remainder_ = 0.0;
};

double rounded_to(double value, double resolution) {
  return std::round(value / resolution) * resolution;
}

void strike(MeterFeed& feed, const Fault& fault, const MeterPlate& plate, Rng& rng) {
  const double last_good = feed.cells[fault.first - 1].value;
  for (std::size_t slot = fault.first; slot < fault.first + fault.count; ++slot) {
    Cell& cell = feed.cells[slot];
    switch (fault.kind) {
      case FaultKind::gap:
        cell.state = CellState::absent;
        break;
      case FaultKind::blank:
        cell.state = CellState::blank;
        break;
      case FaultKind::stuck:
        cell.value = last_good;
        break;
      case FaultKind::zero:
        cell.value = 0.0;
        break;
      case FaultKind::spike:
        cell.value =
            rounded_to(plate.spike_min * std::pow(plate.spike_max / plate.spike_min, rng.uniform()),
                       plate.resolution);
        break;
      case FaultKind::negative:
        cell.value = -std::max(plate.resolution,
                               rounded_to(rng.uniform(0.05, 0.9) * cell.value, plate.resolution));
        break;
    }
  }
}

}  // namespace

const MeterPlate& plate_of(MeterKind kind) { return kPlates[static_cast<std::size_t>(kind)]; }

double power_of(const UtilityPower& power, MeterKind kind) {
  switch (kind) {
    case MeterKind::chilled_water:
      return power.chilled_water_kW;
    case MeterKind::electricity:
      return power.electricity_kW;
    case MeterKind::steam:
      return power.steam_kW;
  }
  return 0.0;
}

MeterFeed read_meter(const Recording& recording, MeterKind kind, std::uint64_t seed,
                     bool with_faults) {
  const MeterPlate& plate = plate_of(kind);
  const auto index = static_cast<std::uint64_t>(kind);
  Rng noise = stream_of(seed, Stream::meter_noise, index);
  MeterFeed feed{kind, 1.0 + plate.gain_error_share * noise.normal(), {}, {}};
  Register meter(plate, noise);
  feed.cells.reserve(recording.power.size());
  for (const UtilityPower& power : recording.power) {
    feed.cells.push_back({meter.read(power_of(power, kind), feed.gain), CellState::value});
  }
  if (!with_faults) return feed;
  Rng chance = stream_of(seed, Stream::meter_faults, index);
  const double years = static_cast<double>(recording.power.size()) / (365.25 * 96.0);
  const int lost_months =
      plate.in_steam_pit ? std::max(1, static_cast<int>(std::lround(0.6 * years))) : 0;
  feed.faults = plan_faults(plate.in_steam_pit ? steam_pit_habits() : healthy_habits(), lost_months,
                            feed.cells.size(), chance);
  for (const Fault& fault : feed.faults) strike(feed, fault, plate, chance);
  return feed;
}

WeatherFeed read_weather_station(const Recording& recording, std::uint64_t seed, bool with_faults) {
  Rng rng = stream_of(seed, Stream::weather_station);
  WeatherFeed feed{0.15 * rng.normal(), 0.012 * rng.normal(), 1.0 + 0.012 * rng.normal(), {}, {}};
  feed.cells.reserve(recording.weather.size());
  for (const WeatherMean& mean : recording.weather) {
    WeatherMean read = mean;
    read.dry_bulb_C += feed.dry_bulb_bias_K + 0.08 * rng.normal();
    read.relative_humidity =
        std::clamp(read.relative_humidity + feed.humidity_bias + 0.008 * rng.normal(), 0.02, 1.0);
    read.wind_speed_m_s = std::max(0.0, read.wind_speed_m_s + 0.12 * rng.normal());
    read.wind_from_deg = std::fmod(read.wind_from_deg + 3.0 * rng.normal() + 360.0, 360.0);
    const double noise_W_m2 = read.global_horizontal_W_m2 > 0.0 ? 1.5 * rng.normal() : 0.0;
    read.global_horizontal_W_m2 =
        std::max(0.0, feed.pyranometer_gain * read.global_horizontal_W_m2 + noise_W_m2);
    feed.cells.push_back({read, false, false});
  }
  if (!with_faults) return feed;
  feed.faults = plan_faults(weather_station_habits(), 0, feed.cells.size(), rng);
  for (const Fault& fault : feed.faults) {
    for (std::size_t slot = fault.first; slot < fault.first + fault.count; ++slot) {
      (fault.kind == FaultKind::gap ? feed.cells[slot].absent : feed.cells[slot].humidity_blank) =
          true;
    }
  }
  return feed;
}

}  // namespace recald::simulators
