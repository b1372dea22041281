#include "simulators/feed/meters.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr double kTon_kW = 3.516853;
constexpr double kBtuPerQuarterHour_kW = 4.0 * 0.29307107;
constexpr double kThermPerQuarterHour_kW = 100.0 * kBtuPerQuarterHour_kW;

MeterPlate chilled_water_plate(double rated_kW) {
  const double size = rated_kW / 2500.0;
  return {.utility = Utility::cooling,
          .id = "chilled_water",
          .kind = "chilled_water",
          .unit = "ton",
          .unit_kW = kTon_kW,
          .resolution = 0.1,
          .decimals = 1,
          .noise_share = 0.008,
          .noise_floor = 0.15 * size,
          .gain_error_share = 0.005,
          .counts = false,
          .spike_min = 1000.0 * size,
          .spike_max = 7000.0 * size,
          .rated_kW = rated_kW,
          .in_steam_pit = false};
}

MeterPlate electricity_plate(double rated_kW) {
  const double size = rated_kW / 900.0;
  return {.utility = Utility::electricity,
          .id = "electricity",
          .kind = "electricity",
          .unit = "kW",
          .unit_kW = 1.0,
          .resolution = rated_kW < 400.0 ? 0.1 : 0.5,  // the current transformers' ratio
          .decimals = 1,
          .noise_share = 0.005,
          .noise_floor = 0.3 * size,
          .gain_error_share = 0.003,
          .counts = true,
          .spike_min = 1300.0 * size,
          .spike_max = 9000.0 * size,
          .rated_kW = rated_kW,
          .in_steam_pit = false};
}

MeterPlate steam_plate(double rated_kW) {
  const double size = rated_kW / 2000.0;
  return {.utility = Utility::heat,
          .id = "steam",
          .kind = "steam",
          .unit = "kBtu",
          .unit_kW = kBtuPerQuarterHour_kW,
          .resolution = 1.0,
          .decimals = 0,
          .noise_share = 0.03,
          .noise_floor = 2.0 * size,
          .gain_error_share = 0.01,
          .counts = true,
          .spike_min = 4000.0 * size,
          .spike_max = 60'000.0 * size,
          .rated_kW = rated_kW,
          .in_steam_pit = true};
}

MeterPlate heating_plate(double rated_kW) {
  MeterPlate plate = steam_plate(rated_kW);
  plate.id = "heating";
  plate.kind = "heating";
  plate.unit = "kWh";
  plate.unit_kW = 4.0;
  plate.resolution = 0.1;
  plate.decimals = 1;
  plate.noise_share = 0.01;
  plate.noise_floor = 0.0002 * rated_kW;
  plate.spike_min = 0.6 * rated_kW;
  plate.spike_max = 4.0 * rated_kW;
  plate.in_steam_pit = false;
  return plate;
}

MeterPlate gas_plate(double rated_kW) {
  MeterPlate plate = heating_plate(rated_kW);
  plate.id = "gas";
  plate.kind = "gas";
  plate.unit = "therm";
  plate.unit_kW = kThermPerQuarterHour_kW;
  plate.resolution = 0.01;
  plate.decimals = 2;
  plate.noise_share = 0.005;
  plate.noise_floor = 0.0;  // a bellows meter counts or does not
  plate.spike_min = 2.4 * rated_kW / kThermPerQuarterHour_kW;
  plate.spike_max = 16.0 * rated_kW / kThermPerQuarterHour_kW;
  return plate;
}

/// Turns the true power into the meter's display, without faults.
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

std::vector<MeterPlate> plates_of(const Drawings& drawings) {
  std::vector<MeterPlate> plates{electricity_plate(drawings.electricity_rated_kW)};
  if (drawings.cooling != CoolingPlant::packaged) {
    plates.insert(plates.begin(), chilled_water_plate(drawings.cooling_rated_kW));
  }
  switch (drawings.heating) {
    case HeatingPlant::district_steam:
      plates.push_back(steam_plate(drawings.heat_rated_kW));
      break;
    case HeatingPlant::district_water:
      plates.push_back(heating_plate(drawings.heat_rated_kW));
      break;
    case HeatingPlant::boiler:
      plates.push_back(gas_plate(drawings.heat_rated_kW));
      break;
    case HeatingPlant::heat_pump:
      break;
  }
  return plates;
}

MeterPlate neighbour_plate() {
  MeterPlate plate = electricity_plate(200.0);
  plate.id = "neighbour";
  return plate;
}

namespace {

/// Effects in the meter change what its display shows; the file keeps the display's digits.
void distort(MeterFeed& feed, const Recording& recording, const HiddenEffects& effects,
             const metering::LocalCalendar& calendar) {
  const MeterPlate& plate = feed.plate;
  std::vector<double> shown_kW;
  for (const Cell& cell : feed.cells) shown_kW.push_back(cell.value * plate.unit_kW);
  const std::vector<double> before_kW = shown_kW;
  for (const auto& effect : effects) {
    effect->distort({plate.utility, recording.begin, calendar, shown_kW});
  }
  for (std::size_t slot = 0; slot < shown_kW.size(); ++slot) {
    if (shown_kW[slot] == before_kW[slot]) continue;
    feed.cells[slot].value = rounded_to(shown_kW[slot] / plate.unit_kW, plate.resolution);
  }
}

}  // namespace

MeterFeed read_meter(const Recording& recording, const MeterPlate& plate, MeterCare care,
                     std::uint64_t seed, const HiddenEffects& effects,
                     const metering::LocalCalendar& calendar) {
  const auto index = static_cast<std::uint64_t>(plate.utility);
  Rng noise = stream_of(seed, Stream::meter_noise, index);
  MeterFeed feed{plate, 1.0 + plate.gain_error_share * noise.normal(), {}, {}};
  Register meter(plate, noise);
  feed.cells.reserve(recording.power.size());
  for (const UtilityPower& power : recording.power) {
    feed.cells.push_back({meter.read(power[plate.utility], feed.gain), CellState::value});
  }
  distort(feed, recording, effects, calendar);
  if (care == MeterCare::perfect) return feed;
  Rng chance = stream_of(seed, Stream::meter_faults, index);
  const double years = static_cast<double>(recording.power.size()) / (365.25 * 96.0);
  const bool poor = care == MeterCare::usual && plate.in_steam_pit;
  const int lost_months = poor ? std::max(1, static_cast<int>(std::lround(0.6 * years))) : 0;
  feed.faults = plan_faults(poor                       ? steam_pit_habits()
                            : care == MeterCare::usual ? healthy_habits()
                                                       : gap_habits(),
                            lost_months, feed.cells.size(), chance);
  for (const Fault& fault : feed.faults) strike(feed, fault, plate, chance);
  return feed;
}

WeatherFeed read_weather_station(const Recording& recording, MeterCare care, std::uint64_t seed) {
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
  if (care == MeterCare::perfect) return feed;
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
