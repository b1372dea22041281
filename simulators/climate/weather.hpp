/// Synthetic weather: fronts, persistent air masses, clouds, sun, rain and snow.
///
/// The generator simulates air masses rather than marginal distributions: a front arrives, cools
/// and dries the air, turns the wind and clears the sky behind it. Temperature, humidity, cloud,
/// wind and rain are correlated because they share that cause. `Climate` describes the place.
#pragma once

#include "simulators/chance/chance.hpp"
#include "simulators/climate/air.hpp"
#include "simulators/climate/climates.hpp"
#include "simulators/climate/sun.hpp"

namespace recald::simulators {

/// The default step.
inline constexpr std::chrono::seconds kStep{300};
inline constexpr double kStep_s = 300.0;

/// Outdoor conditions, constant over one step.
struct Outdoors {
  AirState air;
  double pressure_Pa;
  double relative_humidity;  ///< 0…1.
  double wind_speed_m_s;     ///< 10 m above open ground.
  double wind_from_deg;
  double sky_temperature_C;  ///< Of a black sky with the same radiation as the real one.
  double global_horizontal_W_m2;
  SkyRadiation sky;
  SunPosition sun;
  double precipitation_mm_h;  ///< As water, from rain and snow.
  double snow_share;          ///< Of the precipitation, 0…1; 0 when dry.
  double snow_cover_mm;       ///< Snow on flat unheated surfaces, as water.
  double ground_reflectance;  ///< 0.2 without snow.
};

/// Steps the atmosphere. The same rng state and step give the same weather; another step gives
/// different weather with the same statistics.
class WeatherGenerator {
 public:
  /// @pre step is 1 to 60 minutes
  WeatherGenerator(const Climate& climate, metering::Instant begin, Rng rng,
                   std::chrono::seconds step = kStep);

  /// Computes the next step; the first call starts at `begin`.
  Outdoors advance();

 private:
  struct AirMass {
    double anomaly_K;    ///< Of the daily mean, relative to the season.
    double dryness_K;    ///< Added to the dew point.
    double cloud_logit;  ///< Added to the tendency.
    double lift;         ///< See `RainCause`.
    double gust_factor;
    double wind_from_deg;
  };

  /// One instant of the year, as used by the generator.
  struct Moment {
    double year_share;
    double solar_hour;
    double winter;      ///< 1 in mid-winter, 0 in mid-summer.
    double monsoon;     ///< 0…1.
    double convection;  ///< Afternoon cumulus, logits.
  };

  struct Wind {
    double speed_m_s;
    double from_deg;
  };

  [[nodiscard]] Moment moment(metering::Instant t) const;
  void schedule_next_front(double year_share);
  void move_fronts(double year_share, double anomaly_K);
  [[nodiscard]] AirMass air_mass() const;
  [[nodiscard]] double cloud_cover(const AirMass& mass, const Moment& when);
  [[nodiscard]] double dry_bulb_C(const AirMass& mass, const Moment& when, double spell_K);
  [[nodiscard]] double dew_C(const AirMass& mass, const Moment& when, double spell_K, double air_C);
  [[nodiscard]] Wind wind(const AirMass& mass, const Moment& when, double cloud);
  void precipitate(const RainCause& cause, Outdoors& outdoors);

  Climate climate_;
  Rng rng_;
  metering::Instant now_;
  std::chrono::seconds step_;
  double step_s_;
  double days_since_front_ = 0.0;
  double days_to_front_ = 0.0;
  double last_front_K_ = 0.0;
  double next_front_K_ = 0.0;
  double anomaly_at_passage_K_ = 0.0;  ///< The last front replaces this within hours.
  double smooth_cloud_ = 0.5;  ///< Mean cloud cover of about half a day: damps the daily swing.
  Persistence spell_;          ///< Weeks that are warmer or cooler than the season.
  Persistence synoptic_;
  Persistence moisture_;
  Persistence cloud_system_;
  Persistence cloud_cell_;
  Persistence wind_level_;
  Persistence wind_turn_;
  Persistence pressure_;
  Precipitation precipitation_;
  SnowCover snow_;
};

}  // namespace recald::simulators
