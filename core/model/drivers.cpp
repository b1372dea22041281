#include "core/model/drivers.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/weather/psychrometrics.hpp"

namespace recald::model {
namespace {

using metering::Instant;

constexpr std::chrono::hours kHour{1};

std::vector<weather::Orientation> orientations_of(const Building& building) {
  std::vector<weather::Orientation> found;
  for (const Surface& surface : building.surfaces) {
    if (surface.kind == SurfaceKind::ground) continue;
    if (std::ranges::find(found, surface.orientation) == found.end()) {
      found.push_back(surface.orientation);
    }
  }
  return found;
}

constexpr double kAssumedHumidity_pct = 50.0;
constexpr double kAssumedWind_m_s = 3.0;

/// Name of the first variable that the model needs and this hour lacks; empty when complete.
std::string missing_variable(const weather::WeatherHour* hour, const Drivers& drivers) {
  if (hour == nullptr) return "any value";
  if (!std::isfinite(hour->dry_bulb_C)) return "dry_bulb_C";
  if (drivers.has_humidity && !std::isfinite(hour->rel_humidity_pct)) return "rel_humidity_pct";
  if (drivers.has_wind && !std::isfinite(hour->wind_speed_m_s)) return "wind_speed_m_s";
  if (!std::isfinite(hour->ghi_W_m2)) return "ghi_W_m2";
  return {};
}

bool is_recorded(const weather::WeatherSeries& weather, double weather::WeatherHour::*variable) {
  return std::ranges::any_of(weather.hours, [variable](const weather::WeatherHour& hour) {
    return std::isfinite(hour.*variable);
  });
}

DriverHour describe_hour(int month, Instant start, const metering::LocalCalendar& calendar,
                         const Holidays& holidays, const Building& building,
                         const ElectricLoads& loads, const weather::Location& location,
                         const weather::WeatherHour& weather, const Drivers& drivers) {
  const metering::LocalTime local = calendar.local_time(start);
  const DayType day = day_type(local.date, holidays);
  const int hour = local.minute_of_day / 60;
  const auto calendar_month = static_cast<unsigned>(local.date.month());
  const auto season = std::ranges::find_if(building.seasons, [&](const Season& one) {
    return one.has_own_use() && one.contains(local.date);
  });
  const bool in_season = season != building.seasons.end();
  const HourlySchedule& people = in_season && season->occupied_fraction
                                     ? *season->occupied_fraction
                                     : building.occupied_fraction;
  const auto runs = [&](bool Season::*plant) {
    return std::ranges::all_of(building.seasons, [&](const Season& one) {
      return one.*plant || !one.contains(local.date);
    });
  };
  const double factor = loads.month_factor[calendar_month - 1];
  const double humidity_pct =
      drivers.has_humidity ? weather.rel_humidity_pct : kAssumedHumidity_pct;
  const double relative_humidity = std::clamp(humidity_pct / 100.0, 0.0, 1.0);
  const std::chrono::sys_days date{local.date};
  const std::chrono::sys_days first_of_year{local.date.year() / std::chrono::January / 1};
  const bool is_summer_time =
      calendar.utc_offset(start) > calendar.standard_offset(local.date.year());
  return {.start = start,
          .date = local.date,
          .day_index = 0,
          .weekday = std::chrono::weekday{date}.c_encoding(),
          .day_of_year = static_cast<int>((date - first_of_year).count()) + 1,
          .daylight_saving = is_summer_time,
          .month = month,
          .day = day,
          .local_hour = hour,
          .occupied = !(in_season && season->closed) && is_occupied(building.set_points, day, hour),
          .heating = runs(&Season::heating),
          .cooling = runs(&Season::cooling),
          .dry_bulb_C = weather.dry_bulb_C,
          .humidity_ratio =
              weather::humidity_ratio(weather.dry_bulb_C, relative_humidity, drivers.pressure_Pa),
          .wind_m_s = drivers.has_wind ? std::max(weather.wind_speed_m_s, 0.0) : kAssumedWind_m_s,
          .wind_direction_deg = weather.wind_dir_deg,
          .sine_of_sun_altitude = weather::sun_position(start + kHour / 2, location).cos_zenith,
          .global_horizontal_W_m2 = std::max(weather.ghi_W_m2, 0.0),
          .hours_to_start = 0.0,
          .hours_since_stop = 0.0,
          .hours_since_start = 0.0,
          .hours_to_stop = 0.0,
          .occupied_fraction = people.at(day, hour),
          .lights_W = 1e3 * factor * loads.lights_kW.at(day, hour),
          .plugs_W = 1e3 * factor * loads.plugs_kW.at(day, hour)};
}

/// Counts days, and the hours from and to the changes between day and night operation. Before the
/// first change and after the last, they count from the ends of the record.
void add_distances(std::vector<DriverHour>& hours) {
  if (hours.empty()) return;
  const std::chrono::sys_days first{hours.front().date};
  double in_state_h = 0.0;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    DriverHour& hour = hours[i];
    hour.day_index = static_cast<int>((std::chrono::sys_days{hour.date} - first).count());
    in_state_h = i > 0 && hours[i - 1].occupied == hour.occupied ? in_state_h + 1.0 : 0.5;
    (hour.occupied ? hour.hours_since_start : hour.hours_since_stop) = in_state_h;
  }
  for (std::size_t i = hours.size(); i-- > 0;) {
    DriverHour& hour = hours[i];
    const bool same = i + 1 < hours.size() && hours[i + 1].occupied == hour.occupied;
    in_state_h = same ? in_state_h + 1.0 : 0.5;
    (hour.occupied ? hour.hours_to_stop : hour.hours_to_start) = in_state_h;
  }
}

/// Sun on each orientation in the middle of the hour, from measured beam and diffuse if available.
Eigen::ArrayXd irradiance_of_hour(const std::vector<weather::Orientation>& orientations,
                                  const weather::Location& location, Instant start,
                                  const weather::WeatherHour& hour) {
  const Instant middle = start + kHour / 2;
  const weather::SunPosition sun = weather::sun_position(middle, location);
  const double global_W_m2 = std::max(hour.ghi_W_m2, 0.0);
  const bool measured = std::isfinite(hour.dni_W_m2) && std::isfinite(hour.dhi_W_m2);
  const weather::SplitIrradiance sky =
      measured
          ? weather::SplitIrradiance{std::max(hour.dni_W_m2, 0.0), std::max(hour.dhi_W_m2, 0.0)}
          : weather::split_global_horizontal(global_W_m2, sun, middle);
  Eigen::ArrayXd result(static_cast<Eigen::Index>(orientations.size()));
  for (Eigen::Index k = 0; k < result.size(); ++k) {
    result[k] = weather::irradiance_on_W_m2(orientations[static_cast<std::size_t>(k)], sky,
                                            global_W_m2, sun);
  }
  return result;
}

}  // namespace

bool is_occupied(const SetPoints& set_points, DayType day, int local_hour) {
  const bool working = day == DayType::workday ||
                       (day == DayType::saturday && set_points.saturday_occupied) ||
                       (day == DayType::sunday_or_holiday && set_points.sunday_occupied);
  return working && set_points.occupied_from_hour <= local_hour &&
         local_hour < set_points.occupied_to_hour;
}

Result<Drivers> make_drivers(const std::vector<metering::Month>& months,
                             const metering::LocalCalendar& calendar, const Holidays& holidays,
                             const Building& building, const ElectricLoads& loads,
                             const weather::Location& location,
                             const weather::WeatherSeries& weather, MissingWeather missing) {
  Drivers drivers;
  drivers.months = months;
  drivers.orientations = orientations_of(building);
  drivers.pressure_Pa = weather::pressure_at_altitude_Pa(location.altitude_m);

  if (missing == MissingWeather::assume) {
    drivers.has_humidity = is_recorded(weather, &weather::WeatherHour::rel_humidity_pct);
    drivers.has_wind = is_recorded(weather, &weather::WeatherHour::wind_speed_m_s);
  }

  std::vector<Instant> starts;
  for (std::size_t month = 0; month < months.size(); ++month) {
    const metering::TimeSpan span = calendar.month_span(months[month]);
    // In zones with a half-hour offset the first hour is shared with the previous
    // month; it counts here.
    for (Instant t = std::chrono::ceil<std::chrono::hours>(span.begin); t < span.end; t += kHour) {
      const weather::WeatherHour* hour = weather.find(t);
      if (const std::string lacking = missing_variable(hour, drivers); !lacking.empty()) {
        return failure(ErrorCode::not_enough_data, "the weather lacks " + lacking + " at " +
                                                       metering::to_string(t) +
                                                       ", in a month that the model needs (" +
                                                       metering::to_string(months[month]) +
                                                       "); provide weather that covers the meters");
      }
      drivers.hours.push_back(describe_hour(static_cast<int>(month), t, calendar, holidays,
                                            building, loads, location, *hour, drivers));
      starts.push_back(t);
    }
  }
  add_distances(drivers.hours);
  drivers.irradiance_W_m2.resize(static_cast<Eigen::Index>(drivers.orientations.size()),
                                 static_cast<Eigen::Index>(starts.size()));
  for (std::size_t i = 0; i < starts.size(); ++i) {
    drivers.irradiance_W_m2.col(static_cast<Eigen::Index>(i)) =
        irradiance_of_hour(drivers.orientations, location, starts[i], *weather.find(starts[i]));
  }
  return drivers;
}

}  // namespace recald::model
