/// Hourly inputs of a building model: weather, sun on each side, people, lights and plugs.
///
/// The known inputs x of eq. (3) of the seed, prepared once per revision of weather and schedules.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/model/building.hpp"
#include "core/model/schedule.hpp"
#include "core/result.hpp"
#include "core/weather/sun.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::model {

/// Lights and plugs as derived from the electricity meter: kW by kind of day and local hour.
struct ElectricLoads {
  HourlySchedule lights_kW;
  HourlySchedule plugs_kW;
  /// Factor of each calendar month on both; all 1 if the profile is constant over the year.
  std::array<double, 12> month_factor = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
};

/// One hour, starting on the full UTC hour.
struct DriverHour {
  metering::Instant start;
  metering::Day date;    ///< Local.
  int day_index;         ///< Local days since the day of the first hour.
  unsigned weekday;      ///< 0 Sunday … 6 Saturday, whether a holiday or not.
  int day_of_year;       ///< 1…366
  bool daylight_saving;  ///< The local clock is ahead of its winter time.
  int month;             ///< Index into Drivers::months.
  DayType day;
  int local_hour;  ///< 0…23
  bool occupied;   ///< Set-points and fans at their daytime values.
  bool heating;    ///< The plant runs.
  bool cooling;
  double dry_bulb_C;
  double humidity_ratio;  ///< kg/kg
  double wind_m_s;
  double wind_direction_deg;    ///< From north, clockwise; NaN if not recorded.
  double sine_of_sun_altitude;  ///< In the middle of the hour; negative at night.
  double global_horizontal_W_m2;
  double hours_to_start;    ///< Until set-points and fans next go to daytime values; 0 during them.
  double hours_since_stop;  ///< Since they last left them; 0 during them.
  double hours_since_start;  ///< As above within a day of operation; 0 outside. All four are
  double hours_to_stop;      ///< counted from the middle of the hour.
  double occupied_fraction;
  double lights_W;
  double plugs_W;
};

/// Local days since the day of the first hour, with the local hour as fraction; never decreases.
[[nodiscard]] inline double elapsed_days(const DriverHour& hour) {
  return hour.day_index + hour.local_hour / 24.0;
}

struct Drivers {
  std::vector<metering::Month> months;
  std::vector<DriverHour> hours;                   ///< In order of time, months adjacent to months.
  std::vector<weather::Orientation> orientations;  ///< Distinct ones of the building's surfaces.
  Eigen::ArrayXXd irradiance_W_m2;                 ///< (orientations x hours)
  double pressure_Pa = 101325.0;
  bool has_humidity = true;  ///< False: it was assumed, here as 50 % or already in the weather.
  bool has_wind = true;      ///< As above; here as 3 m/s.
};

/// What to do if the whole weather record lacks humidity or wind.
enum class MissingWeather {
  refuse,  ///< The model needs both.
  assume,  ///< Assume 50 % and 3 m/s and flag it in the drivers: nothing may be concluded from
           ///< them.
};

/// @param months   Months to model, ascending; they need not be adjacent.
/// @param weather  Hourly; must be finite in dry bulb, humidity, wind and sun in every
///                 hour of the months.
/// @return not_enough_data, naming the first hour with missing weather and what is missing.
[[nodiscard]] Result<Drivers> make_drivers(const std::vector<metering::Month>& months,
                                           const metering::LocalCalendar& calendar,
                                           const Holidays& holidays, const Building& building,
                                           const ElectricLoads& loads,
                                           const weather::Location& location,
                                           const weather::WeatherSeries& weather,
                                           MissingWeather missing = MissingWeather::refuse);

/// Whether set-points and fans are at their daytime values.
[[nodiscard]] bool is_occupied(const SetPoints& set_points, DayType day, int local_hour);

}  // namespace recald::model
