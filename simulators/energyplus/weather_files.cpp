#include "simulators/energyplus/weather_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace recald::simulators::energyplus {
namespace {

using metering::Day;
using metering::Instant;

constexpr std::chrono::hours kHour{1};

Instant year_begin(int year, std::chrono::seconds standard_offset) {
  return std::chrono::sys_days{std::chrono::year{year} / 1 / 1} - standard_offset;
}

std::string day_text(Day day) {
  return fmt::format("{}/{}", static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
}

/// First and last day of summer time.
std::string summer_time(const metering::LocalCalendar& calendar, int year) {
  const auto standard = calendar.standard_offset(std::chrono::year{year});
  std::optional<Day> first;
  std::optional<Day> last;
  const std::chrono::sys_days end{std::chrono::year{year + 1} / 1 / 1};
  for (std::chrono::sys_days day{std::chrono::year{year} / 1 / 1}; day < end;
       day += std::chrono::days{1}) {
    const Instant noon = day + std::chrono::hours{12} - standard;
    if (calendar.utc_offset(noon) == standard) continue;
    if (!first) first = Day{day};
    last = Day{day};
  }
  return first ? day_text(*first) + "," + day_text(*last) : "0,0";
}

std::string header(int year, const Place& place, const metering::LocalCalendar& calendar,
                   const std::vector<Day>& holidays) {
  std::string days;
  for (std::size_t i = 0; i < holidays.size(); ++i) {
    days += fmt::format(",Holiday {},{}", i + 1, day_text(holidays[i]));
  }
  constexpr const char* kWeekdays[] = {"Sunday",   "Monday", "Tuesday", "Wednesday",
                                       "Thursday", "Friday", "Saturday"};
  const std::chrono::weekday first{std::chrono::sys_days{std::chrono::year{year} / 1 / 1}};
  return fmt::format(
      "LOCATION,Simulated,-,-,recald-sim,0,{},{},{},{}\n"
      "DESIGN CONDITIONS,0\nTYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\n"
      "HOLIDAYS/DAYLIGHT SAVINGS,{},{},{}{}\n"
      "COMMENTS 1,Simulated weather\nCOMMENTS 2,\n"
      "DATA PERIODS,1,1,Data,{},1/1/{},12/31/{}\n",
      place.latitude_deg, place.longitude_deg,
      metering::in_hours(calendar.standard_offset(std::chrono::year{year})), place.altitude_m,
      std::chrono::year{year}.is_leap() ? "Yes" : "No", summer_time(calendar, year),
      holidays.size(), days, kWeekdays[first.c_encoding()], year, year);
}

double dew_point_of(const Outdoors& at) {
  return std::min(dew_point_C(vapour_pressure_Pa(at.air.humidity_kg_kg, at.pressure_Pa)),
                  at.air.temperature_C);
}

double sky_infrared_W_m2(const Outdoors& at) {
  constexpr double kStefanBoltzmann_W_m2K4 = 5.670374e-8;
  return kStefanBoltzmann_W_m2K4 * std::pow(at.sky_temperature_C + 273.15, 4.0);
}

std::string row(const WeatherHour& hour, std::chrono::seconds standard_offset) {
  const auto local = hour.end - kHour + standard_offset;
  const auto day = std::chrono::floor<std::chrono::days>(local);
  const Day date{day};
  const Outdoors& at = hour.at_end;
  return fmt::format(
      "{},{},{},{},60,,{:.2f},{:.2f},{:.1f},{:.0f},9999,9999,{:.1f},{:.1f},{:.1f},{:.1f},999999,"
      "999999,999999,9999,{:.0f},{:.2f},5,5,9999,99999,9,999999999,999,0.999,999,99,0,0,0\n",
      static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
      static_cast<unsigned>(date.day()), (local - day) / kHour + 1, at.air.temperature_C,
      dew_point_of(at), 100.0 * at.relative_humidity, at.pressure_Pa, sky_infrared_W_m2(at),
      hour.global_W_m2, hour.beam_normal_W_m2, hour.diffuse_W_m2, at.wind_from_deg,
      at.wind_speed_m_s);
}

WeatherHour next_hour(WeatherGenerator& generator, Instant begin) {
  constexpr auto kSteps = kHour / kStep;
  WeatherHour hour{.end = begin + kHour,
                   .at_end = {},
                   .global_W_m2 = 0.0,
                   .beam_normal_W_m2 = 0.0,
                   .diffuse_W_m2 = 0.0};
  for (int step = 0; step < kSteps; ++step) {
    hour.at_end = generator.advance();
    hour.global_W_m2 += hour.at_end.global_horizontal_W_m2 / kSteps;
    hour.beam_normal_W_m2 += hour.at_end.sky.beam_normal_W_m2 / kSteps;
    hour.diffuse_W_m2 += hour.at_end.sky.diffuse_horizontal_W_m2 / kSteps;
  }
  return hour;
}

}  // namespace

std::vector<WeatherHour> simulate_hours(const Climate& climate, int first_year, int years,
                                        std::uint64_t seed,
                                        const metering::LocalCalendar& calendar) {
  const auto offset = calendar.standard_offset(std::chrono::year{first_year});
  const Instant begin = year_begin(first_year, offset);
  const Instant end = year_begin(first_year + years, offset);
  WeatherGenerator generator(climate, begin, stream_of(seed, Stream::weather));
  std::vector<WeatherHour> hours;
  for (Instant at = begin; at < end; at += kHour) hours.push_back(next_hour(generator, at));
  return hours;
}

std::string epw_text(const std::vector<WeatherHour>& hours, int year, const Place& place,
                     const metering::LocalCalendar& calendar, const std::vector<Day>& holidays) {
  const auto offset = calendar.standard_offset(std::chrono::year{year});
  std::string text = header(year, place, calendar, holidays);
  for (const WeatherHour& hour : hours) {
    const bool is_in_year =
        hour.end > year_begin(year, offset) && hour.end <= year_begin(year + 1, offset);
    if (is_in_year) text += row(hour, offset);
  }
  return text;
}

std::string weather_csv(const std::vector<WeatherHour>& hours) {
  std::string text =
      "timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2,dni_W_m2,"
      "dhi_W_m2,pressure_Pa\n";
  for (const WeatherHour& hour : hours) {
    text += fmt::format("{},{:.2f},{:.1f},{:.2f},{:.0f},{:.1f},{:.1f},{:.1f},{:.0f}\n",
                        metering::to_string(hour.end), hour.at_end.air.temperature_C,
                        100.0 * hour.at_end.relative_humidity, hour.at_end.wind_speed_m_s,
                        hour.at_end.wind_from_deg, hour.global_W_m2, hour.beam_normal_W_m2,
                        hour.diffuse_W_m2, hour.at_end.pressure_Pa);
  }
  return text;
}

}  // namespace recald::simulators::energyplus
