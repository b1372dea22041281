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

/// Name of the first variable the model needs and this hour lacks; empty when complete.
std::string missing_variable(const weather::WeatherHour* hour) {
  if (hour == nullptr) return "any value";
  if (!std::isfinite(hour->dry_bulb_C)) return "dry_bulb_C";
  if (!std::isfinite(hour->rel_humidity_pct)) return "rel_humidity_pct";
  if (!std::isfinite(hour->wind_speed_m_s)) return "wind_speed_m_s";
  if (!std::isfinite(hour->ghi_W_m2)) return "ghi_W_m2";
  return {};
}

DriverHour describe_hour(int month, Instant start, const metering::LocalCalendar& calendar,
                         const Holidays& holidays, const Building& building,
                         const ElectricLoads& loads, const weather::WeatherHour& weather,
                         double pressure_Pa) {
  const metering::LocalTime local = calendar.local_time(start);
  const DayType day = day_type(local.date, holidays);
  const int hour = local.minute_of_day / 60;
  const auto calendar_month = static_cast<unsigned>(local.date.month());
  const double factor = loads.month_factor[calendar_month - 1];
  const double relative_humidity = std::clamp(weather.rel_humidity_pct / 100.0, 0.0, 1.0);
  return {
      .month = month,
      .day = day,
      .local_hour = hour,
      .occupied = is_occupied(building.set_points, day, hour),
      .dry_bulb_C = weather.dry_bulb_C,
      .humidity_ratio = weather::humidity_ratio(weather.dry_bulb_C, relative_humidity, pressure_Pa),
      .wind_m_s = std::max(weather.wind_speed_m_s, 0.0),
      .occupied_fraction = building.occupied_fraction.at(day, hour),
      .lights_W = 1e3 * factor * loads.lights_kW.at(day, hour),
      .plugs_W = 1e3 * factor * loads.plugs_kW.at(day, hour)};
}

/// Sun on each orientation in the middle of the hour; measured beam and diffuse where there are
/// any.
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
  const bool working =
      day == DayType::workday || (day == DayType::saturday && set_points.saturday_occupied);
  return working && set_points.occupied_from_hour <= local_hour &&
         local_hour < set_points.occupied_to_hour;
}

Result<Drivers> make_drivers(const std::vector<metering::Month>& months,
                             const metering::LocalCalendar& calendar, const Holidays& holidays,
                             const Building& building, const ElectricLoads& loads,
                             const weather::Location& location,
                             const weather::WeatherSeries& weather) {
  Drivers drivers;
  drivers.months = months;
  drivers.orientations = orientations_of(building);
  drivers.pressure_Pa = weather::pressure_at_altitude_Pa(location.altitude_m);

  std::vector<Instant> starts;
  for (std::size_t month = 0; month < months.size(); ++month) {
    const metering::TimeSpan span = calendar.month_span(months[month]);
    // Zones half an hour off share their first hour with the month before; it counts here.
    for (Instant t = std::chrono::ceil<std::chrono::hours>(span.begin); t < span.end; t += kHour) {
      const weather::WeatherHour* hour = weather.find(t);
      if (const std::string lacking = missing_variable(hour); !lacking.empty()) {
        return failure(ErrorCode::not_enough_data, "the weather lacks " + lacking + " at " +
                                                       metering::to_string(t) +
                                                       ", in a month that the model needs (" +
                                                       metering::to_string(months[month]) +
                                                       "); give weather that covers the meters");
      }
      drivers.hours.push_back(describe_hour(static_cast<int>(month), t, calendar, holidays,
                                            building, loads, *hour, drivers.pressure_Pa));
      starts.push_back(t);
    }
  }
  drivers.irradiance_W_m2.resize(static_cast<Eigen::Index>(drivers.orientations.size()),
                                 static_cast<Eigen::Index>(starts.size()));
  for (std::size_t i = 0; i < starts.size(); ++i) {
    drivers.irradiance_W_m2.col(static_cast<Eigen::Index>(i)) =
        irradiance_of_hour(drivers.orientations, location, starts[i], *weather.find(starts[i]));
  }
  return drivers;
}

}  // namespace recald::model
