#include "daemon/site/calibrate/meter_days.hpp"

#include <algorithm>
#include <cmath>

#include "core/absent.hpp"

namespace recald::daemon {
namespace {

using change_point::MeterDay;
using metering::Day;
using metering::Month;

/// A day that has lost more of its hours than this is not usable.
constexpr int kLeastHours = 20;

double mean_dry_bulb_C(const metering::LocalCalendar& calendar, const SiteWeather& weather,
                       Day day) {
  const metering::TimeSpan span = calendar.day_span(day);
  double sum = 0.0;
  int count = 0;
  for (auto t = std::chrono::ceil<std::chrono::hours>(span.begin); t < span.end;
       t += std::chrono::hours{1}) {
    const weather::WeatherHour* hour = weather.filled.series.find(t);
    if (hour == nullptr || std::isnan(hour->dry_bulb_C)) continue;
    sum += hour->dry_bulb_C;
    ++count;
  }
  return count >= kLeastHours ? sum / count : kAbsent;
}

}  // namespace

std::map<Day, double> daily_dry_bulbs_C(const metering::LocalCalendar& calendar,
                                        const SiteWeather& weather,
                                        const std::vector<Month>& months) {
  std::map<Day, double> temperatures;
  for (const Month month : months) {
    for (int d = 1; d <= metering::days_in(month); ++d) {
      const Day day = month / d;
      temperatures[day] = mean_dry_bulb_C(calendar, weather, day);
    }
  }
  return temperatures;
}

std::map<Day, double> daily_energies_kWh(const MeterRecord& record) {
  std::map<Day, std::pair<double, int>> sums;
  for (const auto& [month, hours] : record.hours) {
    for (const model::HourlyLoad& hour : hours) {
      if (std::isnan(hour.mean_kW) || hour.suspect) continue;
      auto& [sum, count] = sums[hour.date];
      sum += hour.mean_kW;
      ++count;
    }
  }
  std::map<Day, double> energies;
  for (const auto& [day, sum] : sums) {
    if (sum.second >= kLeastHours) energies[day] = 24.0 * sum.first / sum.second;
  }
  return energies;
}

std::vector<MeterDay> meter_days(const model::Holidays& holidays, const SiteCalibration& result,
                                 const assessment::OutputCalibration& output,
                                 assessment::MonthRole role,
                                 const std::map<Day, double>& temperatures,
                                 const std::map<Day, double>& energies) {
  std::vector<MeterDay> days;
  for (std::size_t i = 0; i < result.months.size(); ++i) {
    if (result.roles[i] != role) continue;
    const Month month = result.months[i];
    for (int d = 1; d <= metering::days_in(month); ++d) {
      const Day day = month / d;
      const auto energy = energies.find(day);
      const bool is_known = energy != energies.end() && !std::isnan(output.measured[i]);
      days.push_back({day, model::day_type(day, holidays), is_known ? energy->second : kAbsent,
                      temperatures.at(day)});
    }
  }
  std::ranges::sort(days, {}, &MeterDay::date);
  return days;
}

}  // namespace recald::daemon
