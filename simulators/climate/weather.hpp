/// Invented weather of a hot-humid place: fronts, air masses that persist, clouds, sun.
///
/// The generator steps air masses rather than marginal distributions: a front arrives, cools and
/// dries the air, turns the wind to the north-west and clears the sky behind it. Temperature,
/// humidity, cloud and wind are correlated because they share that cause.
#pragma once

#include <array>
#include <vector>

#include "simulators/chance/chance.hpp"
#include "simulators/climate/air.hpp"
#include "simulators/climate/sun.hpp"

namespace recald::simulators {

inline constexpr std::chrono::seconds kStep{300};
inline constexpr double kStep_s = 300.0;

/// Twelve monthly means as a smooth curve through the year (mean and two harmonics).
class SeasonalCurve {
 public:
  explicit SeasonalCurve(const std::array<double, 12>& monthly_means);

  /// @param year_share 0 at the start of January, 1 at the end of December.
  [[nodiscard]] double at(double year_share) const;

 private:
  double mean_;
  std::array<double, 2> cosine_;
  std::array<double, 2> sine_;
};

/// What the generator aims at; published 1991-2020 normals of Atlanta where there are any.
struct Climate {
  Place place;
  SeasonalCurve dry_bulb_C;
  SeasonalCurve dew_point_C;
  SeasonalCurve cloud_tendency;       ///< Logit of the typical cloud cover.
  SeasonalCurve front_amplitude_K;    ///< Typical strength of a front.
  SeasonalCurve front_interval_days;  ///< Mean time between fronts.
  SeasonalCurve wind_speed_m_s;
};

[[nodiscard]] Climate hot_humid_climate(const Place& place);

/// The outdoors, constant over one step of `kStep`.
struct Outdoors {
  AirState air;
  double pressure_Pa;
  double relative_humidity;  ///< 0…1.
  double wind_speed_m_s;     ///< 10 m above open ground.
  double wind_from_deg;
  double sky_temperature_C;  ///< Of a black sky that radiates as the real one does.
  double global_horizontal_W_m2;
  SkyRadiation sky;
  SunPosition sun;
};

/// Steps the atmosphere. The same rng state gives the same weather.
class WeatherGenerator {
 public:
  WeatherGenerator(Climate climate, metering::Instant begin, Rng rng);

  /// The next `kStep`, beginning at `begin` on the first call.
  Outdoors advance();

 private:
  struct AirMass {
    double anomaly_K;    ///< Of the daily mean against the season.
    double dryness_K;    ///< Added to the dew point.
    double cloud_logit;  ///< Added to the tendency.
    double gust_factor;
    double wind_from_deg;
  };

  /// One instant of the calendar as the generator needs it.
  struct Moment {
    double year_share;
    double solar_hour;
    double winter;  ///< 1 in mid-winter, 0 in mid-summer.
  };

  [[nodiscard]] Moment moment(metering::Instant t) const;
  void schedule_next_front(double year_share);
  void move_fronts(double year_share, double anomaly_K);
  [[nodiscard]] double dry_bulb_C(const AirMass& mass, const Moment& when, double spell_K);
  [[nodiscard]] double dew_C(const AirMass& mass, const Moment& when, double spell_K, double air_C);
  [[nodiscard]] double wind_m_s(const AirMass& mass, const Moment& when);
  [[nodiscard]] AirMass air_mass() const;
  [[nodiscard]] double cloud_cover(const AirMass& mass, const Moment& when);
  [[nodiscard]] SkyRadiation radiation(double cloud, double up, double winter) const;

  Climate climate_;
  Rng rng_;
  metering::Instant now_;
  double days_since_front_ = 0.0;
  double days_to_front_ = 0.0;
  double last_front_K_ = 0.0;
  double next_front_K_ = 0.0;
  double anomaly_at_passage_K_ = 0.0;  ///< The last front replaces this within hours.
  double smooth_cloud_ = 0.5;  ///< Cloud cover of about the last half day: damps the daily swing.
  Persistence spell_;          ///< Weeks that are warmer or cooler than the season.
  Persistence synoptic_;
  Persistence moisture_;
  Persistence cloud_system_;
  Persistence cloud_cell_;
  Persistence wind_level_;
  Persistence wind_turn_;
  Persistence pressure_;
};

}  // namespace recald::simulators
