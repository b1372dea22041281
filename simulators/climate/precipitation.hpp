/// Rain and snow from the generator's clouds, and the snow that stays on the ground.
///
/// Cloud, fronts and convection decide when it falls, and the month how much; nothing here affects
/// them. Uses its own random stream.
#pragma once

#include "simulators/chance/chance.hpp"
#include "simulators/climate/season.hpp"

namespace recald::simulators {

/// How readily a climate's clouds rain. Wetness is dimensionless; it rains or snows
/// while it is positive.
struct RainHabit {
  SeasonalCurve dryness;        ///< Subtracted from the wetness: decides how often.
  SeasonalCurve log_intensity;  ///< Logarithm of mm/h at a wetness of 1: decides how much.
  double per_moisture_K;        ///< Wetness per dew point above the season's.
  SummerRise showers;           ///< Wetness that changes within half an hour, one sigma.
};

/// The state of the atmosphere in one step.
struct RainCause {
  double year_share;
  double cloud;       ///< Share of the sky, 0…1.
  double lift;        ///< From a front: 0 far away, 1 and more at its passage.
  double convection;  ///< Afternoon cumulus, logits of cloud cover.
  double dryness_K;   ///< Air minus dew point: rain evaporates in dry air.
  double moisture_K;  ///< Dew point above the season's: moist air yields more.
};

class Precipitation {
 public:
  Precipitation(const RainHabit& habit, double step_s, Rng rng);

  /// Liquid water, rain and melted snow alike, over the next step.
  double advance_mm_h(const RainCause& cause);

 private:
  RainHabit habit_;
  Rng rng_;
  Persistence system_;
  Persistence cell_;
};

/// Share of the precipitation that falls as snow: all at a wet bulb of 0 degC and below, none from
/// 1.6, half at 0.8.
/// @see Wang, Broxton, Fang, Behrangi, Barlage, Zeng, Niu (2019), Geophys. Res. Lett. 46, where a
///      logistic curve has the same half-way point.
[[nodiscard]] double snow_share(double wet_bulb_C);

/// The weather that acts on a snow cover during a step.
struct MeltWeather {
  double air_C;
  double sky_C;  ///< See `sky_temperature_C`.
  double wind_speed_m_s;
  double global_horizontal_W_m2;
};

/// Snow on flat unheated surfaces, as millimetres of water.
///
/// It melts by the energy that reaches a surface at 0 degC: absorbed sunshine, convection and
/// long-wave radiation. Rain runs through. Left out: the cold stored in the snow, sublimation and
/// condensation, drift.
class SnowCover {
 public:
  void advance(double snowfall_mm, const MeltWeather& weather, double step_s);

  [[nodiscard]] double water_mm() const { return water_mm_; }

  /// Reflectance of the ground for sunshine: 0.2 without snow, 0.7 under 10 mm of water or more.
  [[nodiscard]] double ground_reflectance() const;

 private:
  [[nodiscard]] double covered_share() const;  ///< Of the ground, 0…1.

  double water_mm_ = 0.0;
};

}  // namespace recald::simulators
