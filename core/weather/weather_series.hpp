/// Hourly weather as plain values, made regular and whole from whatever was recorded.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/absent.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::weather {

using metering::Instant;

/// Means over one hour; NaN where absent.
struct WeatherHour {
  double dry_bulb_C = kAbsent;
  double rel_humidity_pct = kAbsent;
  double wind_speed_m_s = kAbsent;
  double wind_dir_deg = kAbsent;  ///< Where the wind comes from, 0 = 360 = north, clockwise.
  double ghi_W_m2 = kAbsent;      ///< Global horizontal irradiance.
  double dni_W_m2 = kAbsent;      ///< Direct normal irradiance.
  double dhi_W_m2 = kAbsent;      ///< Diffuse horizontal irradiance.
  double pressure_Pa = kAbsent;   ///< At the station, not reduced to sea level.
};

/// The columns of `WeatherHour`, for code that treats them alike, with the values that can occur on
/// the ground. What files have slightly beyond (105 % humidity, −4 W/m2 at night) is set to the
/// limit; more than `tolerated` beyond, it is no value.
struct WeatherVariable {
  std::string_view name;
  double WeatherHour::*member;
  double low;
  double high;
  double tolerated = 0.0;

  [[nodiscard]] constexpr bool is_possible(double value) const {
    return low - tolerated <= value && value <= high + tolerated;
  }
};
inline constexpr std::array<WeatherVariable, 8> kWeatherVariables{{
    {"dry_bulb_C", &WeatherHour::dry_bulb_C, -90.0, 60.0},
    {"rel_humidity_pct", &WeatherHour::rel_humidity_pct, 0.0, 100.0, 10.0},
    {"wind_speed_m_s", &WeatherHour::wind_speed_m_s, 0.0, 110.0},
    {"wind_dir_deg", &WeatherHour::wind_dir_deg, 0.0, 360.0},
    {"ghi_W_m2", &WeatherHour::ghi_W_m2, 0.0, 1600.0, 30.0},
    {"dni_W_m2", &WeatherHour::dni_W_m2, 0.0, 1400.0, 30.0},
    {"dhi_W_m2", &WeatherHour::dhi_W_m2, 0.0, 1200.0, 30.0},
    {"pressure_Pa", &WeatherHour::pressure_Pa, 50e3, 110e3},
}};

/// Consecutive hours on the UTC hour.
struct WeatherSeries {
  Instant begin{};  ///< Start of the first hour, a full hour.
  std::vector<WeatherHour> hours;

  [[nodiscard]] Instant end() const { return begin + std::chrono::hours{hours.size()}; }
  /// The hour that contains `t`, or null outside the series.
  [[nodiscard]] const WeatherHour* find(Instant t) const;
};

/// One observation as a file has it, of [start, start + step).
struct WeatherRecord {
  Instant start;
  WeatherHour values;
};

/// Where the temperature, humidity, wind and pressure of a record stand. Irradiance is the mean of
/// the record in any case.
enum class ValuesStand : std::uint8_t { over_the_record, at_its_start, at_its_end };

/// Puts records of any step on the UTC hour: each hour is the mean of what overlaps it, weighted by
/// the overlap; it stays absent where less than half is covered. Between two instants a value runs
/// on a straight line; where its neighbour is absent it stands for the whole record. Wind direction
/// is the direction of the mean vector, weighted by speed where known. Of a step above an hour only
/// the first hour is taken as observed; the rest is for `fill_gaps`. Records with the same start:
/// the first stays.
/// @param step  the records' length, e.g. 15 minutes.
/// @return not_enough_data without records; otherwise a series from the first to the last record.
[[nodiscard]] Result<WeatherSeries> to_hourly(std::span<const WeatherRecord> records,
                                              std::chrono::seconds step,
                                              ValuesStand stand = ValuesStand::over_the_record);

/// Where the hours of a local month came from, as shares 0…1, in order of `kWeatherVariables`.
struct WeatherCoverage {
  metering::Month month;
  std::array<double, kWeatherVariables.size()> measured{};
  std::array<double, kWeatherVariables.size()> interpolated{};
  std::array<double, kWeatherVariables.size()> typical{};  ///< By hour-of-day mean of the month.
};

/// What a month's weather is good for, by the share of it that was measured or interpolated.
enum class WeatherGrade : std::uint8_t {
  unknown,  ///< Less than half: mostly invented, it cannot be held against a model.
  patchy,   ///< Good enough to be used, with a warning.
  good,     ///< 90 % and more.
};
[[nodiscard]] WeatherGrade grade_of(double known_share);

struct FilledWeather {
  WeatherSeries series;
  std::vector<WeatherCoverage> coverage;  ///< One entry per local month, in order.
};

/// Fills each variable by itself: gaps up to `interpolate_max` on a straight line (wind direction
/// along the shorter arc), longer ones with the mean of the same local hour in the same local
/// month. A variable that has no value at that hour in the month stays absent; it is not invented.
/// The months that `span` touches are covered whole: hours outside the records count as absent.
[[nodiscard]] FilledWeather fill_gaps(const WeatherSeries& series,
                                      const metering::LocalCalendar& calendar,
                                      std::chrono::seconds interpolate_max = std::chrono::hours{6});

/// The weather from `from` on, as it is known at `known_until`; its last seven days go on from
/// there to `until`. Less than seven days are given back as they are.
[[nodiscard]] WeatherSeries continued(const WeatherSeries& series, Instant from,
                                      Instant known_until, Instant until);

}  // namespace recald::weather
