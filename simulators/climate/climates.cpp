#include "simulators/climate/climates.hpp"

namespace recald::simulators {
namespace {

constexpr std::array<std::string_view, 5> kNames{"hot-humid", "hot-dry", "mixed", "cold", "marine"};

constexpr Monsoon kNoMonsoon{
    .begin_year_share = 0.0, .end_year_share = 0.0, .dew_rise_K = 0.0, .convection = 0.0};
constexpr ThermalBreeze kNoBreeze{.speed_m_s = {0.0, 0.0}, .day_from_deg = 0.0};

/// Like Atlanta: fronts all winter, moist southerly air and afternoon cumulus all summer.
Climate hot_humid(const Place& place) {
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
      .day = {.swing_K = SeasonalCurve(7.1),
              .cloud_damping_K = 4.5,
              .overcast_shift_K = {1.0, -2.2},
              .dew_swing_K = 0.0},
      .variability = {.spell_K = {0.7, 0.7},
                      .synoptic_K = {1.0, 1.8},
                      .synoptic_days = 3.0,
                      .dew_per_synoptic = 0.0,
                      .moisture_K = {1.2, 3.4},
                      .cloud_moisture_K = 2.0,
                      .dew_per_anomaly = 1.30},
      .front = {.full_strength_K = 4.0, .cloud_ahead = 2.6, .cloud_behind = 2.0, .clearing = 1.5},
      .cloud = {.convection = {0.0, 1.1}, .morning_stratus = {0.0, 0.0}},
      .wind = {.behind_front_from_deg = 310.0,
               .veer_deg = 230.0,
               .veer_days = 2.5,
               .daily_share = 0.28,
               .breeze = kNoBreeze},
      .monsoon = kNoMonsoon,
      .haze = {0.055, 0.06},
      .overcast_transmittance = {0.29, 0.0},
      .rain = {.dryness = SeasonalCurve(
                   {1.19, 1.12, 1.16, 1.25, 1.33, 1.39, 1.45, 1.55, 1.64, 1.66, 1.55, 1.36}),
               .log_intensity = SeasonalCurve(
                   {0.83, 0.83, 1.07, 1.34, 1.52, 1.66, 1.88, 2.16, 2.31, 2.17, 1.71, 1.17}),
               .per_moisture_K = 0.10,
               .showers = {0.2, 0.4}},
  };
}

/// Like Phoenix: weak fronts from the Pacific in winter, then a dry hot early summer that the
/// monsoon ends within days. East wind down the valley by night, west wind up it by day.
Climate hot_dry(const Place& place) {
  return {
      .place = place,
      .dry_bulb_C =
          SeasonalCurve({13.1, 15.5, 19.1, 23.0, 27.3, 31.7, 34.8, 34.9, 31.0, 24.3, 17.5, 13.5}),
      .dew_point_C = SeasonalCurve({0.1, -0.1, 0.7, 1.9, 3.5, 5.8, 8.3, 9.9, 9.7, 7.6, 4.4, 1.6}),
      .cloud_tendency = SeasonalCurve(
          {-0.17, 0.20, -0.86, -2.53, -3.65, -3.73, -3.27, -3.12, -3.50, -3.79, -3.20, -1.68}),
      .front_amplitude_K =
          SeasonalCurve({4.0, 4.2, 5.0, 5.6, 5.0, 3.5, 1.6, 1.6, 3.0, 4.6, 4.8, 4.2}),
      .front_interval_days =
          SeasonalCurve({6.0, 6.0, 6.0, 6.5, 7.5, 9.0, 11.0, 11.0, 9.5, 8.0, 7.0, 6.0}),
      .wind_speed_m_s = SeasonalCurve({2.3, 2.5, 2.8, 2.9, 2.9, 2.8, 2.8, 2.7, 2.6, 2.4, 2.2, 2.1}),
      .day = {.swing_K =
                  SeasonalCurve({7.6, 7.9, 8.0, 7.8, 7.5, 7.2, 7.0, 7.0, 7.0, 7.0, 7.0, 7.2}),
              .cloud_damping_K = 4.0,
              .overcast_shift_K = {0.5, -3.0},
              .dew_swing_K = -1.2},
      .variability = {.spell_K = {0.7, 0.6},
                      .synoptic_K = {1.0, 1.1},
                      .synoptic_days = 3.0,
                      .dew_per_synoptic = 0.2,
                      .moisture_K = {2.8, 0.8},
                      .cloud_moisture_K = 5.0,
                      .dew_per_anomaly = 0.30},
      .front = {.full_strength_K = 4.0, .cloud_ahead = 2.0, .cloud_behind = 1.4, .clearing = 1.0},
      .cloud = {.convection = {0.0, 0.3}, .morning_stratus = {0.0, 0.0}},
      .wind = {.behind_front_from_deg = 280.0,
               .veer_deg = 250.0,
               .veer_days = 3.0,
               .daily_share = 0.15,
               .breeze = {.speed_m_s = {0.8, 1.4}, .day_from_deg = 265.0}},
      .monsoon = {.begin_year_share = 0.505,
                  .end_year_share = 0.715,
                  .dew_rise_K = 7.0,
                  .convection = 1.2},
      .haze = {-0.05, 0.11},
      .overcast_transmittance = {0.45, 0.0},
      .rain = {.dryness = SeasonalCurve(
                   {1.63, 1.72, 0.87, -0.25, -0.82, -0.60, -0.09, 0.05, -0.30, -0.61, -0.27, 0.71}),
               .log_intensity = SeasonalCurve(
                   {1.66, 1.77, 1.52, 1.15, 1.00, 1.18, 1.46, 1.53, 1.31, 1.02, 0.99, 1.29}),
               .per_moisture_K = 0.10,
               .showers = {0.2, 0.4}},
  };
}

/// Like Baltimore: strong fronts in winter, weak ones in summer, a bay breeze on fine days.
Climate mixed(const Place& place) {
  return {
      .place = place,
      .dry_bulb_C =
          SeasonalCurve({0.9, 2.4, 6.6, 12.5, 18.6, 23.5, 25.8, 24.9, 20.7, 14.3, 7.8, 2.9}),
      .dew_point_C =
          SeasonalCurve({-5.8, -5.2, -1.7, 4.1, 10.9, 16.7, 19.6, 18.8, 14.6, 8.3, 1.8, -3.2}),
      .cloud_tendency = SeasonalCurve(
          {-0.30, -0.14, -0.01, -0.03, -0.26, -0.60, -0.86, -0.90, -0.75, -0.56, -0.44, -0.38}),
      .front_amplitude_K =
          SeasonalCurve({8.4, 8.2, 8.2, 7.6, 6.0, 4.4, 3.4, 3.4, 4.8, 6.6, 7.8, 8.4}),
      .front_interval_days =
          SeasonalCurve({4.2, 4.2, 4.2, 4.6, 5.2, 5.8, 6.4, 6.6, 6.0, 5.2, 4.6, 4.2}),
      .wind_speed_m_s = SeasonalCurve({4.0, 4.2, 4.3, 4.3, 3.9, 3.5, 3.3, 3.3, 3.4, 3.6, 3.8, 3.8}),
      .day = {.swing_K =
                  SeasonalCurve({5.7, 6.3, 7.4, 8.3, 8.4, 8.1, 7.9, 8.0, 8.1, 7.8, 7.0, 6.1}),
              .cloud_damping_K = 5.0,
              .overcast_shift_K = {1.0, -2.4},
              .dew_swing_K = 0.0},
      .variability = {.spell_K = {0.8, 1.3},
                      .synoptic_K = {1.2, 2.7},
                      .synoptic_days = 4.0,
                      .dew_per_synoptic = 0.8,
                      .moisture_K = {1.5, 1.6},
                      .cloud_moisture_K = 2.4,
                      .dew_per_anomaly = 1.30},
      .front = {.full_strength_K = 4.0, .cloud_ahead = 2.6, .cloud_behind = 2.0, .clearing = 1.4},
      .cloud = {.convection = {0.0, 0.9}, .morning_stratus = {0.0, 0.2}},
      .wind = {.behind_front_from_deg = 310.0,
               .veer_deg = 240.0,
               .veer_days = 2.3,
               .daily_share = 0.26,
               .breeze = {.speed_m_s = {0.0, 1.2}, .day_from_deg = 140.0}},
      .monsoon = kNoMonsoon,
      .haze = {0.05, 0.06},
      .overcast_transmittance = {0.27, 0.0},
      .rain = {.dryness = SeasonalCurve(
                   {1.17, 1.05, 0.99, 1.04, 1.19, 1.38, 1.53, 1.59, 1.56, 1.49, 1.39, 1.29}),
               .log_intensity = SeasonalCurve(
                   {1.05, 0.95, 0.86, 0.92, 1.22, 1.72, 2.20, 2.40, 2.23, 1.83, 1.44, 1.19}),
               .per_moisture_K = 0.06,
               .showers = {0.2, 0.4}},
  };
}

/// Like Minneapolis: arctic outbreaks, Gulf air in summer, snow on the ground for months.
Climate cold(const Place& place) {
  return {
      .place = place,
      .dry_bulb_C =
          SeasonalCurve({-9.4, -7.0, -0.3, 8.2, 15.9, 21.2, 23.3, 22.0, 17.2, 9.6, 0.8, -6.5}),
      .dew_point_C =
          SeasonalCurve({-13.0, -11.7, -6.9, -0.0, 7.4, 13.4, 16.6, 15.8, 11.0, 3.6, -4.3, -10.3}),
      .cloud_tendency = SeasonalCurve(
          {0.46, 0.03, 0.28, 0.64, 0.39, -0.51, -1.35, -1.27, -0.18, 1.15, 1.74, 1.30}),
      .front_amplitude_K =
          SeasonalCurve({11.5, 11.2, 10.0, 9.2, 7.6, 6.0, 5.0, 5.2, 7.0, 8.8, 10.0, 11.0}),
      .front_interval_days =
          SeasonalCurve({4.2, 4.2, 4.2, 4.4, 4.8, 5.0, 5.4, 5.4, 5.0, 4.6, 4.2, 4.2}),
      .wind_speed_m_s = SeasonalCurve({4.2, 4.4, 4.7, 5.0, 4.8, 4.3, 3.9, 3.9, 4.2, 4.5, 4.5, 4.3}),
      .day = {.swing_K =
                  SeasonalCurve({3.8, 4.4, 6.1, 7.7, 8.0, 7.4, 6.7, 6.9, 7.6, 7.7, 6.6, 4.9}),
              .cloud_damping_K = 6.0,
              .overcast_shift_K = {3.0, -5.0},
              .dew_swing_K = 0.0},
      .variability = {.spell_K = {1.0, 2.2},
                      .synoptic_K = {1.6, 3.5},
                      .synoptic_days = 5.0,
                      .dew_per_synoptic = 1.1,
                      .moisture_K = {1.6, 0.4},
                      .cloud_moisture_K = 2.4,
                      .dew_per_anomaly = 1.15},
      .front = {.full_strength_K = 5.0, .cloud_ahead = 2.2, .cloud_behind = 2.0, .clearing = 1.2},
      .cloud = {.convection = {0.0, 0.9}, .morning_stratus = {0.0, 0.0}},
      .wind = {.behind_front_from_deg = 315.0,
               .veer_deg = 220.0,
               .veer_days = 2.3,
               .daily_share = 0.24,
               .breeze = kNoBreeze},
      .monsoon = kNoMonsoon,
      .haze = {0.02, 0.06},
      .overcast_transmittance = {0.42, -0.13},
      .rain = {.dryness = SeasonalCurve(
                   {1.11, 1.02, 1.11, 1.21, 1.18, 1.08, 1.09, 1.29, 1.61, 1.79, 1.70, 1.39}),
               .log_intensity = SeasonalCurve(
                   {-0.40, -0.09, 0.76, 1.55, 1.89, 1.89, 1.91, 2.12, 2.29, 1.99, 1.12, 0.11}),
               .per_moisture_K = 0.0,
               .showers = {0.15, 0.45}},
  };
}

/// Like Seattle: one mild Pacific front after the other in winter, dry summers whose low cloud
/// burns off by noon; wind from the south-west behind fronts, from the north in fair weather.
Climate marine(const Place& place) {
  return {
      .place = place,
      .dry_bulb_C =
          SeasonalCurve({4.7, 6.0, 8.2, 10.8, 14.0, 17.3, 19.6, 19.7, 16.9, 12.2, 7.7, 5.0}),
      .dew_point_C =
          SeasonalCurve({1.1, 1.6, 3.1, 5.1, 7.6, 10.2, 12.3, 12.8, 11.2, 8.0, 4.5, 2.0}),
      .cloud_tendency = SeasonalCurve(
          {1.44, 1.00, 0.40, -0.16, -0.63, -1.02, -1.28, -1.22, -0.73, 0.10, 0.96, 1.46}),
      .front_amplitude_K =
          SeasonalCurve({3.2, 3.2, 3.2, 3.6, 4.4, 5.0, 5.0, 4.8, 4.0, 3.2, 3.2, 3.2}),
      .front_interval_days =
          SeasonalCurve({3.2, 3.4, 3.4, 3.8, 4.8, 5.6, 8.0, 7.6, 6.0, 4.0, 3.2, 3.2}),
      .wind_speed_m_s = SeasonalCurve({3.9, 3.9, 3.8, 3.8, 3.7, 3.6, 3.4, 3.4, 3.4, 3.5, 3.7, 3.9}),
      .day = {.swing_K =
                  SeasonalCurve({5.2, 5.8, 6.2, 6.3, 6.4, 6.7, 7.1, 7.2, 6.7, 5.9, 5.1, 4.9}),
              .cloud_damping_K = 4.2,
              .overcast_shift_K = {3.0, -4.5},
              .dew_swing_K = 0.0},
      .variability = {.spell_K = {1.1, 1.4},
                      .synoptic_K = {2.3, 0.0},
                      .synoptic_days = 3.0,
                      .dew_per_synoptic = 0.5,
                      .moisture_K = {1.1, 0.8},
                      .cloud_moisture_K = 1.6,
                      .dew_per_anomaly = 0.60},
      .front = {.full_strength_K = 2.6, .cloud_ahead = 2.2, .cloud_behind = 1.4, .clearing = 0.5},
      .cloud = {.convection = {0.0, 0.0}, .morning_stratus = {0.0, 1.8}},
      .wind = {.behind_front_from_deg = 215.0,
               .veer_deg = 300.0,
               .veer_days = 3.5,
               .daily_share = 0.14,
               .breeze = {.speed_m_s = {0.2, 1.0}, .day_from_deg = 350.0}},
      .monsoon = kNoMonsoon,
      .haze = {0.04, 0.02},
      .overcast_transmittance = {0.24, 0.0},
      .rain = {.dryness = SeasonalCurve(
                   {1.11, 1.08, 0.86, 0.64, 0.67, 0.98, 1.35, 1.51, 1.36, 1.07, 0.92, 0.99}),
               .log_intensity = SeasonalCurve(
                   {0.69, 0.74, 0.55, 0.28, 0.22, 0.53, 1.03, 1.34, 1.27, 0.91, 0.60, 0.56}),
               .per_moisture_K = 0.10,
               .showers = {0.15, 0.1}},
  };
}

}  // namespace

std::string_view name_of(ClimateKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

Climate climate_of(ClimateKind kind, const Place& place) {
  switch (kind) {
    case ClimateKind::hot_humid:
      return hot_humid(place);
    case ClimateKind::hot_dry:
      return hot_dry(place);
    case ClimateKind::mixed:
      return mixed(place);
    case ClimateKind::cold:
      return cold(place);
    case ClimateKind::marine:
      break;
  }
  return marine(place);
}

}  // namespace recald::simulators
