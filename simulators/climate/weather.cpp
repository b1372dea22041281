#include "simulators/climate/weather.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace recald::simulators {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kHour_s = 3600.0;
constexpr double kDay_s = 86'400.0;

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

double year_share_of(metering::Instant t) {
  const auto day = std::chrono::floor<std::chrono::days>(t);
  const std::chrono::year_month_day date{day};
  const std::chrono::sys_days new_year{date.year() / 1 / 1};
  const double days_in_year = date.year().is_leap() ? 366.0 : 365.0;
  return std::chrono::duration<double, std::ratio<86'400>>(t - new_year).count() / days_in_year;
}

double solar_hour_of(metering::Instant t, const Place& place) {
  const auto day = std::chrono::floor<std::chrono::days>(t);
  const double utc_hour = std::chrono::duration<double, std::ratio<3600>>(t - day).count();
  return std::fmod(utc_hour + place.longitude_deg / 15.0 + 24.0, 24.0);
}

/// Shape of a day with mean 0 and half range about 1: coldest near sunrise, warmest at 15 h.
double daily_shape(double solar_hour) {
  const double angle = kTurn * (solar_hour - 14.8) / 24.0;
  return 0.92 * std::cos(angle) + 0.16 * std::cos(2.0 * angle + 0.6);
}

/// Effective temperature of the sky: clear-sky emissivity after Berdahl and Martin (1984), Solar
/// Energy 32(5), filled up by cloud.
double sky_temperature_C(double air_C, double dew_C, double cloud) {
  const double d = dew_C / 100.0;
  const double clear = 0.711 + 0.56 * d + 0.73 * d * d;
  const double emissivity = clear + (1.0 - clear) * 0.84 * cloud;
  return (air_C + 273.15) * std::pow(emissivity, 0.25) - 273.15;
}

}  // namespace

SeasonalCurve::SeasonalCurve(const std::array<double, 12>& monthly_means)
    : mean_(0.0), cosine_{}, sine_{} {
  for (std::size_t month = 0; month < 12; ++month) {
    const double angle = kTurn * (static_cast<double>(month) + 0.5) / 12.0;
    mean_ += monthly_means[month] / 12.0;
    for (std::size_t k = 0; k < 2; ++k) {
      const double order = static_cast<double>(k + 1);
      // A monthly mean flattens a harmonic by sin(x)/x, x = pi k / 12; undo that.
      const double x = std::numbers::pi * order / 12.0;
      const double weight = x / std::sin(x) / 6.0;
      cosine_[k] += weight * monthly_means[month] * std::cos(order * angle);
      sine_[k] += weight * monthly_means[month] * std::sin(order * angle);
    }
  }
}

double SeasonalCurve::at(double year_share) const {
  const double c = std::cos(kTurn * year_share);
  const double s = std::sin(kTurn * year_share);
  return mean_ + cosine_[0] * c + sine_[0] * s + cosine_[1] * (c * c - s * s) +
         sine_[1] * 2.0 * s * c;
}

Climate hot_humid_climate(const Place& place) {
  return {
      .place = place,
      .dry_bulb_C =
          SeasonalCurve({6.8, 8.9, 13.0, 17.2, 21.6, 25.3, 26.8, 26.4, 23.4, 17.8, 12.1, 8.2}),
      .dew_point_C =
          SeasonalCurve({-0.2, 1.2, 4.6, 9.2, 14.8, 18.9, 20.9, 20.7, 17.3, 10.9, 5.2, 1.6}),
      .cloud_tendency = SeasonalCurve(
          {0.05, -0.05, -0.25, -0.60, -0.65, -0.65, -0.55, -0.65, -0.60, -0.95, -0.45, 0.05}),
      .front_amplitude_K =
          SeasonalCurve({8.6, 8.4, 7.6, 6.3, 4.4, 2.8, 2.1, 2.1, 3.4, 5.8, 7.4, 8.3}),
      .front_interval_days =
          SeasonalCurve({4.6, 4.6, 4.8, 5.2, 6.0, 7.5, 8.5, 8.5, 7.0, 5.8, 5.0, 4.6}),
      .wind_speed_m_s = SeasonalCurve({4.2, 4.4, 4.4, 4.2, 3.6, 3.3, 3.1, 3.0, 3.4, 3.6, 3.8, 4.0}),
  };
}

WeatherGenerator::WeatherGenerator(Climate climate, metering::Instant begin, Rng rng)
    : climate_(climate),
      rng_(rng),
      now_(begin),
      spell_(25.0 * kDay_s, kStep_s, rng_),
      synoptic_(3.0 * kDay_s, kStep_s, rng_),
      moisture_(1.5 * kDay_s, kStep_s, rng_),
      cloud_system_(10.0 * kHour_s, kStep_s, rng_),
      cloud_cell_(0.4 * kHour_s, kStep_s, rng_),
      wind_level_(5.0 * kHour_s, kStep_s, rng_),
      wind_turn_(8.0 * kHour_s, kStep_s, rng_),
      pressure_(3.0 * kDay_s, kStep_s, rng_) {
  schedule_next_front(year_share_of(begin));
  days_since_front_ = 2.0;
  last_front_K_ = next_front_K_;
}

void WeatherGenerator::schedule_next_front(double year_share) {
  // At least two days apart: a second front into air that has just been replaced is no front.
  const double mean_days = climate_.front_interval_days.at(year_share);
  days_to_front_ = 2.0 + draw_waiting_time(rng_, mean_days - 2.0);
  next_front_K_ = climate_.front_amplitude_K.at(year_share) * rng_.uniform(0.3, 1.7);
}

WeatherGenerator::AirMass WeatherGenerator::air_mass() const {
  // Behind a front cold dry air warms up within days; ahead of the next, southerly air is drawn in.
  // The passage itself takes some hours, hence the blend with the air before it.
  const double behind = -0.75 * last_front_K_ * std::exp(-days_since_front_ / 2.8);
  const double ahead = 0.80 * next_front_K_ * std::exp(-days_to_front_ / 2.4);
  const double passage = 1.0 - std::exp(-days_since_front_ / 0.12);
  const double anomaly = passage * (behind + ahead) + (1.0 - passage) * anomaly_at_passage_K_;

  const double rain_ahead = 2.6 * std::exp(-days_to_front_ / 0.5);
  const double rain_behind = 2.0 * std::exp(-days_since_front_ / 0.25);
  const double clearing =
      -1.5 * (1.0 - std::exp(-days_since_front_ / 0.3)) * std::exp(-days_since_front_ / 1.6);
  const double strength = std::min(1.5, last_front_K_ / 4.0);
  const double gust = 1.0 + 0.5 * strength * std::exp(-days_since_front_ / 0.5);
  const double turned = 230.0 * (1.0 - std::exp(-days_since_front_ / 2.5));
  return {anomaly, 1.30 * anomaly, rain_ahead + strength * (rain_behind + clearing), gust,
          310.0 + turned};
}

double WeatherGenerator::cloud_cover(const AirMass& mass, const Moment& when) {
  // Summer afternoons build cumulus; winter stratus does not follow the clock.
  const double convection =
      1.1 * (1.0 - when.winter) * std::exp(-0.5 * std::pow((when.solar_hour - 15.5) / 2.5, 2.0));
  const double tendency =
      climate_.cloud_tendency.at(when.year_share) + mass.cloud_logit + convection;
  const double layer = logistic(tendency + 1.9 * cloud_system_.advance(rng_));
  const double patchiness = 0.9 * layer * (1.0 - layer);
  return std::clamp(layer + patchiness * cloud_cell_.advance(rng_), 0.0, 1.0);
}

SkyRadiation WeatherGenerator::radiation(double cloud, double up, double winter) const {
  const double outside_W_m2 = extraterrestrial_W_m2(now_ + kStep / 2);
  if (up <= 0.0) return {0.0, 0.0, outside_W_m2};
  // Clear beam after Meinel (1976), with haze that grows in summer; air mass after Kasten, Young.
  const double elevation_deg = std::asin(std::min(1.0, up)) * 360.0 / kTurn;
  const double air_mass = 1.0 / (up + 0.50572 * std::pow(elevation_deg + 6.07995, -1.6364));
  const double haze = 0.055 + 0.06 * (1.0 - winter);
  const double clear_beam =
      outside_W_m2 * std::pow(0.7, std::pow(air_mass, 0.678)) * std::exp(-haze * air_mass);
  const double clear_diffuse = (0.085 + 0.5 * haze) * outside_W_m2 * std::pow(up, 0.7);
  const double overcast = 0.29 * outside_W_m2 * up;
  const double bright_edges = 0.22 * cloud * (1.0 - cloud) * outside_W_m2 * up;
  return {clear_beam * (1.0 - cloud),
          (1.0 - cloud) * clear_diffuse + cloud * overcast + bright_edges, outside_W_m2};
}

WeatherGenerator::Moment WeatherGenerator::moment(metering::Instant t) const {
  const double year_share = year_share_of(t);
  return {year_share, solar_hour_of(t, climate_.place),
          0.5 + 0.5 * std::cos(kTurn * (year_share - 0.05))};
}

double WeatherGenerator::dry_bulb_C(const AirMass& mass, const Moment& when, double spell_K) {
  // Clouds flatten the day; they also cool summer days and keep winter nights from cooling.
  const double swing_K = 7.1 - 4.5 * smooth_cloud_;
  const double cloud_effect_K = (1.0 - 2.2 * (1.0 - when.winter)) * (smooth_cloud_ - 0.5);
  return climate_.dry_bulb_C.at(when.year_share) + mass.anomaly_K + spell_K +
         (1.0 + 1.8 * when.winter) * synoptic_.advance(rng_) + cloud_effect_K +
         swing_K * daily_shape(when.solar_hour);
}

double WeatherGenerator::dew_C(const AirMass& mass, const Moment& when, double spell_K,
                               double air_C) {
  const double free_C = climate_.dew_point_C.at(when.year_share) + mass.dryness_K + spell_K +
                        (1.2 + 3.4 * when.winter) * moisture_.advance(rng_) +
                        2.0 * (smooth_cloud_ - 0.5);
  // Dew forms before fog: the night's cooling stops the dew point just below the air.
  return std::min(air_C - 0.25, free_C);
}

double WeatherGenerator::wind_m_s(const AirMass& mass, const Moment& when) {
  constexpr double spread = 0.45;
  const double breeze = 1.0 + 0.28 * std::cos(kTurn * (when.solar_hour - 14.5) / 24.0);
  const double level = std::exp(spread * wind_level_.advance(rng_) - 0.5 * spread * spread);
  return std::min(28.0,
                  climate_.wind_speed_m_s.at(when.year_share) * breeze * mass.gust_factor * level);
}

void WeatherGenerator::move_fronts(double year_share, double anomaly_K) {
  days_since_front_ += kStep_s / kDay_s;
  days_to_front_ -= kStep_s / kDay_s;
  if (days_to_front_ > 0.0) return;
  last_front_K_ = next_front_K_;
  anomaly_at_passage_K_ = anomaly_K;
  days_since_front_ = 0.0;
  schedule_next_front(year_share);
}

Outdoors WeatherGenerator::advance() {
  const metering::Instant middle = now_ + kStep / 2;
  const Moment when = moment(middle);
  const AirMass mass = air_mass();
  const double cloud = cloud_cover(mass, when);
  smooth_cloud_ += (cloud - smooth_cloud_) * kStep_s / (10.0 * kHour_s);
  const double spell_K = (0.7 + 0.7 * when.winter) * spell_.advance(rng_);
  const double air_C = dry_bulb_C(mass, when, spell_K);
  const double dew_point = dew_C(mass, when, spell_K, air_C);

  Outdoors outdoors{};
  outdoors.pressure_Pa =
      pressure_at_altitude_Pa(climate_.place.altitude_m) + 450.0 * pressure_.advance(rng_);
  outdoors.air = {air_C, saturation_humidity_kg_kg(dew_point, outdoors.pressure_Pa)};
  outdoors.relative_humidity = relative_humidity(outdoors.air, outdoors.pressure_Pa);
  outdoors.wind_speed_m_s = wind_m_s(mass, when);
  outdoors.wind_from_deg =
      std::fmod(mass.wind_from_deg + 28.0 * wind_turn_.advance(rng_) + 720.0, 360.0);
  outdoors.sky_temperature_C = sky_temperature_C(air_C, dew_point, cloud);
  outdoors.sun = sun_position(middle, climate_.place);
  outdoors.sky = radiation(cloud, outdoors.sun.up, when.winter);
  outdoors.global_horizontal_W_m2 = outdoors.sky.beam_normal_W_m2 * std::max(0.0, outdoors.sun.up) +
                                    outdoors.sky.diffuse_horizontal_W_m2;
  now_ += kStep;
  move_fronts(when.year_share, mass.anomaly_K);
  return outdoors;
}

}  // namespace recald::simulators
