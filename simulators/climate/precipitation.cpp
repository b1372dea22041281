#include "simulators/climate/precipitation.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr double kFusion_J_kg = 334'000.0;
constexpr double kBareGroundReflectance = 0.2;
constexpr double kSnowReflectance = 0.7;  ///< Settled snow; fresh snow reaches 0.85.
constexpr double kFullCover_mm = 10.0;    ///< With less than this, some of the ground is bare.
constexpr double kTrace_mm = 0.05;        ///< Gone below this: a thin cover would never quite end.
constexpr double kLongWave_W_m2K = 4.6;   ///< 4 sigma T³ at 273 K.

}  // namespace

Precipitation::Precipitation(const RainHabit& habit, double step_s, Rng rng)
    : habit_(habit), rng_(rng), system_(8.0 * 3600.0, step_s, rng_), cell_(1200.0, step_s, rng_) {}

double Precipitation::advance_mm_h(const RainCause& cause) {
  constexpr double thin_cloud = 0.55;
  const double showers = habit_.showers.at(winter_at(cause.year_share));
  const double chance = 0.9 * system_.advance(rng_) + showers * cell_.advance(rng_);
  // A front lifts air for hours in any season; cumulus rains only where it towers.
  const double wetness = 3.5 * (cause.cloud - 0.8) + 1.1 * cause.lift + 0.6 * cause.convection +
                         habit_.per_moisture_K * cause.moisture_K - 0.12 * cause.dryness_K +
                         chance - habit_.dryness.at(cause.year_share);
  if (wetness <= 0.0 || cause.cloud < thin_cloud) return 0.0;
  const double intensity_mm_h = std::exp(habit_.log_intensity.at(cause.year_share));
  return std::min(90.0, intensity_mm_h * wetness * std::sqrt(wetness));
}

double snow_share(double wet_bulb_C) { return std::clamp(1.0 - wet_bulb_C / 1.6, 0.0, 1.0); }

void SnowCover::advance(double snowfall_mm, const MeltWeather& weather, double step_s) {
  water_mm_ += snowfall_mm;
  if (water_mm_ == 0.0) return;
  // At 10 W/m²K, each kelvin above 0 degC melts 2.6 mm a day; measured: 2 to 5, sunshine included
  // (Hock 2003, J. Hydrology 282).
  const double convection_W_m2K = 2.0 + 1.5 * weather.wind_speed_m_s;
  const double melting_W_m2 = (1.0 - kSnowReflectance) * weather.global_horizontal_W_m2 +
                              convection_W_m2K * weather.air_C + kLongWave_W_m2K * weather.sky_C;
  // One millimetre of water is one kilogram per square metre.
  const double melt_mm = covered_share() * std::max(0.0, melting_W_m2) * step_s / kFusion_J_kg;
  water_mm_ = std::max(0.0, water_mm_ - melt_mm);
  if (water_mm_ < kTrace_mm) water_mm_ = 0.0;
}

double SnowCover::covered_share() const { return std::min(1.0, water_mm_ / kFullCover_mm); }

double SnowCover::ground_reflectance() const {
  return kBareGroundReflectance + (kSnowReflectance - kBareGroundReflectance) * covered_share();
}

}  // namespace recald::simulators
