/// Five climates for the weather generator, each made to resemble one city (see `normals.hpp`).
///
/// A `Climate` is the input of the weather generator. Its curves are targets, not results:
/// fronts, clouds, the saturation limit and the monsoon shift the monthly means, and the curves
/// allow for that. The members describe causes, so climates differ in how their weather arises
/// and not only in their means.
#pragma once

#include <array>
#include <string_view>

#include "simulators/climate/precipitation.hpp"
#include "simulators/climate/season.hpp"
#include "simulators/climate/sun.hpp"

namespace recald::simulators {

enum class ClimateKind { hot_humid, hot_dry, mixed, cold, marine };

inline constexpr std::array<ClimateKind, 5> kClimateKinds{ClimateKind::hot_humid,
                                                          ClimateKind::hot_dry, ClimateKind::mixed,
                                                          ClimateKind::cold, ClimateKind::marine};

/// As written in a scenario: "hot-humid", "hot-dry", "mixed", "cold", "marine".
[[nodiscard]] std::string_view name_of(ClimateKind kind);

/// The course of a day.
struct DailyCycle {
  SeasonalCurve swing_K;        ///< Half the range of a clear day.
  double cloud_damping_K;       ///< Of that half range, lost under full cloud cover.
  SummerRise overcast_shift_K;  ///< Overcast minus clear daily mean.
  double dew_swing_K;  ///< Dew point in the afternoon above (+) the mean; mixing dries the air.
};

/// Deviations of the air from the season; standard deviations.
struct Variability {
  WinterRise spell_K;       ///< Weeks warmer or cooler than the season; the dew point follows.
  WinterRise synoptic_K;    ///< Air masses without a marked front.
  double synoptic_days;     ///< Time constant of these.
  double dew_per_synoptic;  ///< Dew point's share in these, K/K.
  WinterRise moisture_K;    ///< Of the dew point alone.
  double cloud_moisture_K;  ///< Dew point under full cloud cover minus under a clear sky.
  double dew_per_anomaly;   ///< Dew point's share in the warming and cooling about a front, K/K.
};

/// The effects of a front besides its temperature.
struct FrontHabit {
  double full_strength_K;  ///< A front of this size clouds, clears and blows in full.
  double cloud_ahead;      ///< Logits of cloud cover.
  double cloud_behind;
  double clearing;  ///< In the following days.
};

struct CloudHabit {
  SummerRise convection;       ///< Afternoon cumulus, logits.
  SummerRise morning_stratus;  ///< Low cloud that burns off before noon, logits.
};

/// A wind that turns with the sun on clear days: from `day_from_deg` at 15 h, the
/// opposite way at 3 h.
struct ThermalBreeze {
  SummerRise speed_m_s;
  double day_from_deg;
};

struct WindHabit {
  double behind_front_from_deg;
  double veer_deg;  ///< Clockwise turn from there until the next front.
  double veer_days;
  double daily_share;  ///< Afternoon, above the mean.
  ThermalBreeze breeze;
};

/// A season of moist tropical air that starts and ends within days; none if `dew_rise_K` is 0.
struct Monsoon {
  double begin_year_share;
  double end_year_share;
  double dew_rise_K;
  double convection;  ///< Added to the afternoon's cumulus, logits.
};

/// Everything that the generator needs about a place.
struct Climate {
  Place place;
  SeasonalCurve dry_bulb_C;
  SeasonalCurve dew_point_C;
  SeasonalCurve cloud_tendency;       ///< Logit of the typical cloud cover.
  SeasonalCurve front_amplitude_K;    ///< Typical strength of a front.
  SeasonalCurve front_interval_days;  ///< Mean time between fronts; more than 2.
  SeasonalCurve wind_speed_m_s;
  DailyCycle day;
  Variability variability;
  FrontHabit front;
  CloudHabit cloud;
  WindHabit wind;
  Monsoon monsoon;
  SummerRise haze;                    ///< See `Veil`.
  SummerRise overcast_transmittance;  ///< See `Veil`; high over snow, which reflects light back.
  RainHabit rain;
};

/// @param place  In the northern hemisphere; sets the sun and the air pressure. The weather is
///               still that of the comparable city.
[[nodiscard]] Climate climate_of(ClimateKind kind, const Place& place);

[[nodiscard]] inline Climate hot_humid_climate(const Place& place) {
  return climate_of(ClimateKind::hot_humid, place);
}

}  // namespace recald::simulators
