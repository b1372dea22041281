#include "simulators/climate/weather.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "simulators/climate/sky.hpp"

namespace recald::simulators {
namespace {

constexpr double kDaysTurn = 2.0 * std::numbers::pi;
constexpr double kHour_s = 3600.0;

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

double solar_hour_of(metering::Instant t, const Place& place) {
  const auto day = std::chrono::floor<std::chrono::days>(t);
  const double utc_hour = std::chrono::duration<double, std::ratio<3600>>(t - day).count();
  return std::fmod(utc_hour + place.longitude_deg / 15.0 + 24.0, 24.0);
}

/// Shape of a day with mean 0 and half range about 1: coldest near sunrise, warmest at 15 h.
double daily_shape(double solar_hour) {
  const double angle = kDaysTurn * (solar_hour - 14.8) / 24.0;
  return 0.92 * std::cos(angle) + 0.16 * std::cos(2.0 * angle + 0.6);
}

/// 1 when low cloud is thickest, around sunrise; it has burnt off by noon.
double stratus_shape(double solar_hour) {
  const double from_sunrise_h = std::remainder(solar_hour - 5.5, 24.0);
  return std::exp(-0.5 * std::pow(from_sunrise_h / 3.0, 2.0));
}

/// 0…1, starting and ending within about a week.
double monsoon_at(const Monsoon& monsoon, double year_share) {
  constexpr double onset = 0.007;  // of a year
  return logistic((year_share - monsoon.begin_year_share) / onset) *
         logistic((monsoon.end_year_share - year_share) / onset);
}

/// A separate stream, without advancing `weather`.
Rng rain_stream(Rng weather) { return Rng{weather.next(), 1}; }

}  // namespace

WeatherGenerator::WeatherGenerator(const Climate& climate, metering::Instant begin, Rng rng,
                                   std::chrono::seconds step)
    : climate_(climate),
      rng_(rng),
      now_(begin),
      step_(step),
      step_s_(static_cast<double>(step.count())),
      spell_(25.0 * kDay_s, step_s_, rng_),
      synoptic_(climate.variability.synoptic_days * kDay_s, step_s_, rng_),
      moisture_(1.5 * kDay_s, step_s_, rng_),
      cloud_system_(10.0 * kHour_s, step_s_, rng_),
      cloud_cell_(0.4 * kHour_s, step_s_, rng_),
      wind_level_(5.0 * kHour_s, step_s_, rng_),
      wind_turn_(8.0 * kHour_s, step_s_, rng_),
      pressure_(3.0 * kDay_s, step_s_, rng_),
      precipitation_(climate.rain, step_s_, rain_stream(rng)) {
  assert(step >= std::chrono::minutes{1} && step <= std::chrono::hours{1});
  schedule_next_front(year_share_of(begin));
  days_since_front_ = 2.0;
  last_front_K_ = next_front_K_;
}

WeatherGenerator::Moment WeatherGenerator::moment(metering::Instant t) const {
  const double year_share = year_share_of(t);
  const double solar_hour = solar_hour_of(t, climate_.place);
  const double winter = winter_at(year_share);
  const double monsoon = monsoon_at(climate_.monsoon, year_share);
  // Cumulus builds on summer afternoons; winter stratus does not follow the time of day.
  const double convection =
      (climate_.cloud.convection.at(winter) + climate_.monsoon.convection * monsoon) *
      std::exp(-0.5 * std::pow((solar_hour - 15.5) / 2.5, 2.0));
  return {year_share, solar_hour, winter, monsoon, convection};
}

void WeatherGenerator::schedule_next_front(double year_share) {
  // At least two days apart: a front needs time to bring other air.
  const double mean_days = climate_.front_interval_days.at(year_share);
  days_to_front_ = 2.0 + draw_waiting_time(rng_, mean_days - 2.0);
  next_front_K_ = climate_.front_amplitude_K.at(year_share) * rng_.uniform(0.3, 1.7);
}

WeatherGenerator::AirMass WeatherGenerator::air_mass() const {
  // Behind a front, cold dry air warms up within days; ahead of the next, southerly air flows in.
  // The passage itself takes some hours, so the two are blended.
  const double behind = -0.75 * last_front_K_ * std::exp(-days_since_front_ / 2.8);
  const double ahead = 0.80 * next_front_K_ * std::exp(-days_to_front_ / 2.4);
  const double passage = 1.0 - std::exp(-days_since_front_ / 0.12);
  const double anomaly = passage * (behind + ahead) + (1.0 - passage) * anomaly_at_passage_K_;

  const FrontHabit& front = climate_.front;
  const double strength = std::min(1.5, last_front_K_ / front.full_strength_K);
  const double just_ahead = std::exp(-days_to_front_ / 0.5);
  const double just_behind = std::exp(-days_since_front_ / 0.25);
  const double clearing = -front.clearing * (1.0 - std::exp(-days_since_front_ / 0.3)) *
                          std::exp(-days_since_front_ / 1.6);
  const double cloud =
      front.cloud_ahead * just_ahead + strength * (front.cloud_behind * just_behind + clearing);
  const double gust = 1.0 + 0.5 * strength * std::exp(-days_since_front_ / 0.5);
  const WindHabit& wind = climate_.wind;
  const double turned = wind.veer_deg * (1.0 - std::exp(-days_since_front_ / wind.veer_days));
  return {.anomaly_K = anomaly,
          .dryness_K = climate_.variability.dew_per_anomaly * anomaly,
          .cloud_logit = cloud,
          .lift = just_ahead + 0.3 * strength * just_behind,
          .gust_factor = gust,
          .wind_from_deg = wind.behind_front_from_deg + turned};
}

double WeatherGenerator::cloud_cover(const AirMass& mass, const Moment& when) {
  const double tendency =
      climate_.cloud_tendency.at(when.year_share) + mass.cloud_logit + when.convection +
      climate_.cloud.morning_stratus.at(when.winter) * stratus_shape(when.solar_hour);
  const double layer = logistic(tendency + 1.9 * cloud_system_.advance(rng_));
  const double patchiness = 0.9 * layer * (1.0 - layer);
  return std::clamp(layer + patchiness * cloud_cell_.advance(rng_), 0.0, 1.0);
}

double WeatherGenerator::dry_bulb_C(const AirMass& mass, const Moment& when, double spell_K) {
  // Clouds flatten the day; they also cool summer days and keep winter nights warm.
  const DailyCycle& day = climate_.day;
  const double swing_K =
      std::max(0.0, day.swing_K.at(when.year_share) - day.cloud_damping_K * smooth_cloud_);
  const double cloud_effect_K = day.overcast_shift_K.at(when.winter) * (smooth_cloud_ - 0.5);
  return climate_.dry_bulb_C.at(when.year_share) + mass.anomaly_K + spell_K +
         climate_.variability.synoptic_K.at(when.winter) * synoptic_.advance(rng_) +
         cloud_effect_K + swing_K * daily_shape(when.solar_hour);
}

double WeatherGenerator::dew_C(const AirMass& mass, const Moment& when, double spell_K,
                               double air_C) {
  const Variability& variability = climate_.variability;
  const double free_C =
      climate_.dew_point_C.at(when.year_share) + mass.dryness_K + spell_K +
      variability.dew_per_synoptic * variability.synoptic_K.at(when.winter) * synoptic_.value() +
      variability.moisture_K.at(when.winter) * moisture_.advance(rng_) +
      variability.cloud_moisture_K * (smooth_cloud_ - 0.5) +
      climate_.monsoon.dew_rise_K * when.monsoon +
      climate_.day.dew_swing_K * daily_shape(when.solar_hour);
  // Dew forms before fog: the night's cooling stops the dew point just below the air.
  return std::min(air_C - 0.25, free_C);
}

WeatherGenerator::Wind WeatherGenerator::wind(const AirMass& mass, const Moment& when,
                                              double cloud) {
  constexpr double spread = 0.45;
  const double afternoon = std::cos(kDaysTurn * (when.solar_hour - 14.5) / 24.0);
  const double daily = 1.0 + climate_.wind.daily_share * afternoon;
  const double level = std::exp(spread * wind_level_.advance(rng_) - 0.5 * spread * spread);
  const double speed_m_s = std::min(
      28.0, climate_.wind_speed_m_s.at(when.year_share) * daily * mass.gust_factor * level);
  const double from_deg =
      std::fmod(mass.wind_from_deg + 28.0 * wind_turn_.advance(rng_) + 720.0, 360.0);

  const ThermalBreeze& breeze = climate_.wind.breeze;
  const double breeze_m_s = breeze.speed_m_s.at(when.winter) * (1.0 - cloud) * afternoon;
  if (breeze_m_s == 0.0) return {speed_m_s, from_deg};
  const double from = from_deg * kDaysTurn / 360.0;
  const double breeze_from = breeze.day_from_deg * kDaysTurn / 360.0;
  const double east = speed_m_s * std::sin(from) + breeze_m_s * std::sin(breeze_from);
  const double north = speed_m_s * std::cos(from) + breeze_m_s * std::cos(breeze_from);
  const double sum_from_deg = std::atan2(east, north) * 360.0 / kDaysTurn;
  return {std::hypot(east, north), std::fmod(sum_from_deg + 360.0, 360.0)};
}

void WeatherGenerator::precipitate(const RainCause& cause, Outdoors& outdoors) {
  constexpr double too_warm_for_snow_C = 15.0;  // dry bulb; saves computing the wet bulb in summer
  outdoors.precipitation_mm_h = precipitation_.advance_mm_h(cause);
  const double air_C = outdoors.air.temperature_C;
  if (outdoors.precipitation_mm_h > 0.0 && air_C < too_warm_for_snow_C) {
    outdoors.snow_share = snow_share(wet_bulb_C(outdoors.air, outdoors.pressure_Pa));
  }
  const double snowfall_mm = outdoors.precipitation_mm_h * outdoors.snow_share * step_s_ / kHour_s;
  snow_.advance(
      snowfall_mm,
      {air_C, outdoors.sky_temperature_C, outdoors.wind_speed_m_s, outdoors.global_horizontal_W_m2},
      step_s_);
  outdoors.snow_cover_mm = snow_.water_mm();
  outdoors.ground_reflectance = snow_.ground_reflectance();
}

void WeatherGenerator::move_fronts(double year_share, double anomaly_K) {
  days_since_front_ += step_s_ / kDay_s;
  days_to_front_ -= step_s_ / kDay_s;
  if (days_to_front_ > 0.0) return;
  last_front_K_ = next_front_K_;
  anomaly_at_passage_K_ = anomaly_K;
  days_since_front_ = 0.0;
  schedule_next_front(year_share);
}

Outdoors WeatherGenerator::advance() {
  const metering::Instant middle = now_ + step_ / 2;
  const Moment when = moment(middle);
  const AirMass mass = air_mass();
  const double cloud = cloud_cover(mass, when);
  smooth_cloud_ += (cloud - smooth_cloud_) * step_s_ / (10.0 * kHour_s);
  const double spell_K = climate_.variability.spell_K.at(when.winter) * spell_.advance(rng_);
  const double air_C = dry_bulb_C(mass, when, spell_K);
  const double dew_point = dew_C(mass, when, spell_K, air_C);

  Outdoors outdoors{};
  outdoors.pressure_Pa =
      pressure_at_altitude_Pa(climate_.place.altitude_m) + 450.0 * pressure_.advance(rng_);
  outdoors.air = {air_C, saturation_humidity_kg_kg(dew_point, outdoors.pressure_Pa)};
  outdoors.relative_humidity = relative_humidity(outdoors.air, outdoors.pressure_Pa);
  const Wind air_flow = wind(mass, when, cloud);
  outdoors.wind_speed_m_s = air_flow.speed_m_s;
  outdoors.wind_from_deg = air_flow.from_deg;
  outdoors.sky_temperature_C = sky_temperature_C(air_C, dew_point, cloud);
  outdoors.sun = sun_position(middle, climate_.place);
  outdoors.sky = sky_radiation(
      extraterrestrial_W_m2(middle), outdoors.sun.up,
      {climate_.haze.at(when.winter), cloud, climate_.overcast_transmittance.at(when.winter)});
  outdoors.global_horizontal_W_m2 = outdoors.sky.beam_normal_W_m2 * std::max(0.0, outdoors.sun.up) +
                                    outdoors.sky.diffuse_horizontal_W_m2;
  precipitate({when.year_share, cloud, mass.lift, when.convection, air_C - dew_point,
               dew_point - climate_.dew_point_C.at(when.year_share)},
              outdoors);
  now_ += step_;
  move_fronts(when.year_share, mass.anomaly_K);
  return outdoors;
}

}  // namespace recald::simulators
