#include "adapters/epw/epw_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/weather/psychrometrics.hpp"

namespace recald::epw {
namespace {

using metering::Day;
using metering::Instant;
using weather::WeatherHour;

constexpr std::chrono::hours kHour{1};

/// Temperature at which moist air is saturated, °C, by the Magnus form.
/// @see Alduchov and Eskridge (1996), J. Applied Meteorology 35, eq. (25).
double dew_point_C(double dry_bulb_C, double humidity_pct) {
  const double share = std::max(humidity_pct, 1.0) / 100.0;
  const double x = std::log(share) + 17.625 * dry_bulb_C / (243.04 + dry_bulb_C);
  return std::min(243.04 * x / (17.625 - x), dry_bulb_C);
}

std::string day_text(Day day) {
  return fmt::format("{}/{}", static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
}

/// First and last day of summer time; over New Year in the south. "0,0" where there is none.
std::string summer_time(const metering::LocalCalendar& calendar, int year) {
  const auto offset = calendar.standard_offset(std::chrono::year{year});
  const std::chrono::sys_days first{std::chrono::year{year} / 1 / 1};
  const std::chrono::sys_days last{std::chrono::year{year} / 12 / 31};
  const auto is_summer = [&](std::chrono::sys_days day) {
    return calendar.utc_offset(day + std::chrono::hours{12} - offset) > offset;
  };
  std::optional<Day> begins;
  std::optional<Day> ends;
  for (auto day = first; day <= last; day += std::chrono::days{1}) {
    const auto before = day - std::chrono::days{1};
    if (is_summer(day) && !is_summer(before)) begins = Day{day};
    if (!is_summer(day) && is_summer(before)) ends = Day{before};
  }
  if (!begins || !ends) return "0,0";
  return day_text(*begins) + "," + day_text(*ends);
}

std::string header(int year, const weather::Location& location,
                   const metering::LocalCalendar& calendar, const std::set<Day>& holidays,
                   std::string_view name) {
  std::string place{name};
  std::ranges::replace_if(
      place, [](char c) { return c == ',' || c == '\n' || c == '\r'; }, ' ');
  std::string days;
  int count = 0;
  for (const Day day : holidays) {
    if (day.year() != std::chrono::year{year}) continue;
    days += fmt::format(",Holiday {},{}", ++count, day_text(day));
  }
  const double offset_h =
      std::chrono::duration<double, std::ratio<3600>>{
          calendar.standard_offset(std::chrono::year{year})}
          .count();
  const bool is_leap = std::chrono::year{year}.is_leap();
  const std::chrono::weekday first{std::chrono::sys_days{std::chrono::year{year} / 1 / 1}};
  constexpr std::string_view kWeekdays[] = {"Sunday",   "Monday", "Tuesday", "Wednesday",
                                            "Thursday", "Friday", "Saturday"};
  return fmt::format(
      "LOCATION,{},-,-,recald,0,{:.4f},{:.4f},{:.2f},{:.1f}\n"
      "DESIGN CONDITIONS,0\nTYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\n"
      "HOLIDAYS/DAYLIGHT SAVINGS,{},{},{}{}\n"
      "COMMENTS 1,Written by recald from measured weather\nCOMMENTS 2,\n"
      "DATA PERIODS,1,1,Data,{},1/1/{},12/31/{}\n",
      place, location.latitude_deg, location.longitude_deg, offset_h, location.altitude_m,
      is_leap ? "Yes" : "No", summer_time(calendar, year), count, days,
      kWeekdays[first.c_encoding()], year, year);
}

/// Between the means of two hours, at their border; beside a gap the hour's own mean.
double at_end(const WeatherHour& hour, const WeatherHour* next, double WeatherHour::*variable) {
  const double own = hour.*variable;
  return next != nullptr && std::isfinite(next->*variable) ? 0.5 * (own + next->*variable) : own;
}

std::string_view lacking(const WeatherHour* hour) {
  if (hour == nullptr) return "any value";
  for (const auto& [name, member] : {std::pair{"temperature", &WeatherHour::dry_bulb_C},
                                     std::pair{"humidity", &WeatherHour::rel_humidity_pct},
                                     std::pair{"wind", &WeatherHour::wind_speed_m_s},
                                     std::pair{"sun", &WeatherHour::ghi_W_m2}}) {
    if (!std::isfinite(hour->*member)) return name;
  }
  return {};
}

std::string row(Instant start, std::chrono::seconds offset, const WeatherHour& hour,
                const WeatherHour* next, const weather::Location& location) {
  const auto local = start + offset;
  const auto day = std::chrono::floor<std::chrono::days>(local);
  const Day date{day};
  const auto hour_number = (local - day) / kHour + 1;
  const weather::SunPosition sun = weather::sun_position(start + kHour / 2, location);
  const double global_W_m2 = std::max(hour.ghi_W_m2, 0.0);
  const bool is_split = std::isfinite(hour.dni_W_m2) && std::isfinite(hour.dhi_W_m2);
  const weather::SplitIrradiance sky =
      is_split
          ? weather::SplitIrradiance{std::max(hour.dni_W_m2, 0.0), std::max(hour.dhi_W_m2, 0.0)}
          : weather::split_global_horizontal(global_W_m2, sun, start + kHour / 2);
  const double dry_bulb_C = at_end(hour, next, &WeatherHour::dry_bulb_C);
  const double humidity_pct =
      std::clamp(at_end(hour, next, &WeatherHour::rel_humidity_pct), 1.0, 100.0);
  const double wind_m_s = std::max(at_end(hour, next, &WeatherHour::wind_speed_m_s), 0.0);
  const double pressure_Pa = std::isfinite(hour.pressure_Pa)
                                 ? at_end(hour, next, &WeatherHour::pressure_Pa)
                                 : weather::pressure_at_altitude_Pa(location.altitude_m);
  // A direction has no mean of two; the hour's stands.
  const double direction_deg = std::isfinite(hour.wind_dir_deg) ? hour.wind_dir_deg : 0.0;
  return fmt::format(
      "{},{},{},{},60,,{:.2f},{:.2f},{:.1f},{:.0f},9999,9999,9999,{:.1f},{:.1f},{:.1f},999999,"
      "999999,999999,9999,{:.0f},{:.2f},5,5,9999,99999,9,999999999,999,0.999,999,99,0,0,0\n",
      static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
      static_cast<unsigned>(date.day()), hour_number, dry_bulb_C,
      dew_point_C(dry_bulb_C, humidity_pct), humidity_pct, pressure_Pa, global_W_m2,
      sky.direct_normal_W_m2, sky.diffuse_horizontal_W_m2, direction_deg, wind_m_s);
}

}  // namespace

Result<std::string> epw_text(const weather::WeatherSeries& weather, int year,
                             const weather::Location& location,
                             const metering::LocalCalendar& calendar,
                             const std::set<metering::Day>& holidays, std::string_view place) {
  const auto offset = calendar.standard_offset(std::chrono::year{year});
  const Instant begin = std::chrono::sys_days{std::chrono::year{year} / 1 / 1} - offset;
  const Instant end = std::chrono::sys_days{std::chrono::year{year + 1} / 1 / 1} - offset;
  std::string text = header(year, location, calendar, holidays, place);
  for (Instant start = begin; start < end; start += kHour) {
    const WeatherHour* hour = weather.find(start);
    if (const std::string_view what = lacking(hour); !what.empty()) {
      return failure(ErrorCode::not_enough_data,
                     fmt::format("the weather lacks {} at {}; EnergyPlus needs every hour of {}",
                                 what, metering::to_string(start), year));
    }
    text += row(start, offset, *hour, weather.find(start + kHour), location);
  }
  return text;
}

}  // namespace recald::epw
