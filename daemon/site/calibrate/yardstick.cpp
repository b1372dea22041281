#include "daemon/site/calibrate/yardstick.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/absent.hpp"
#include "core/assessment/given_data.hpp"
#include "core/change_point/month_forecast.hpp"
#include "core/change_point/regression.hpp"

namespace recald::daemon {
namespace {

using assessment::Forecast;
using assessment::MonthRole;
using change_point::MeterDay;
using metering::Day;
using metering::Month;

/// A day that has lost more of its hours than this is not usable.
constexpr int kLeastHours = 20;
constexpr int kBlockMonths = 3;

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

/// Mean power of the day's valid hours over a whole day, kWh.
std::map<Day, double> energies_of(const MeterRecord& record) {
  std::map<Day, std::pair<double, int>> sums;
  for (const auto& [month, hours] : record.hours) {
    for (const profile::HourlyLoad& hour : hours) {
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

/// Every day of the result's months with this role, ascending. A month without a usable figure
/// teaches nothing.
std::vector<MeterDay> days_of(const SiteConfig& site, const SiteCalibration& result,
                              const assessment::OutputCalibration& output, MonthRole role,
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
      days.push_back({day, model::day_type(day, site.holidays), is_known ? energy->second : kAbsent,
                      temperatures.at(day)});
    }
  }
  std::ranges::sort(days, {}, &MeterDay::date);
  return days;
}

Forecast normal(double mean, double sd) {
  return {Eigen::VectorXd::Constant(1, mean), Eigen::VectorXd::Constant(1, sd),
          Eigen::VectorXd::Ones(1)};
}

std::size_t place_of(const SiteCalibration& result, Month month) {
  return static_cast<std::size_t>(std::ranges::find(result.months, month) - result.months.begin());
}

void take_left_out(const SiteCalibration& result, std::span<const MeterDay> days, int together,
                   std::vector<std::optional<Forecast>>& forecasts) {
  const auto left_out = change_point::forecast_left_out_months(days, together);
  if (!left_out) return;  // too few months: then nothing is said of them
  for (const change_point::LeftOutMonth& month : *left_out) {
    forecasts[place_of(result, month.month)] = normal(month.daily_average_kWh, month.sd_kWh);
  }
}

void take_unseen(const SiteCalibration& result, const assessment::OutputCalibration& output,
                 const change_point::MonthlyForecast& unseen,
                 assessment::OutputForecasts& forecasts) {
  const auto count = static_cast<Eigen::Index>(unseen.months.size());
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(count);
  for (Eigen::Index m = 0; m < count; ++m) {
    const std::size_t place = place_of(result, unseen.months[static_cast<std::size_t>(m)]);
    forecasts.months[place] =
        normal(unseen.daily_average_kWh(m), std::sqrt(unseen.covariance_kWh2(m, m)));
    if (!std::isnan(output.measured[place])) weights(m) = result.month_days[place];
  }
  if (!(weights.sum() > 0.0)) return;
  weights /= weights.sum();
  forecasts.unseen_mean = normal(weights.dot(unseen.daily_average_kWh),
                                 std::sqrt(weights.dot(unseen.covariance_kWh2 * weights)));
}

}  // namespace

std::vector<std::optional<assessment::OutputForecasts>> yardsticks_of(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather, const SiteCalibration& result) {
  std::map<Day, double> temperatures;
  for (const Month month : result.months) {
    for (int d = 1; d <= metering::days_in(month); ++d) {
      const Day day = month / d;
      temperatures[day] = mean_dry_bulb_C(calendar, weather, day);
    }
  }
  std::vector<std::optional<assessment::OutputForecasts>> yardsticks(result.outputs.size());
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    const assessment::OutputCalibration& output = result.outputs[k];
    if (output.unit == "kW") continue;  // days say nothing of a month's peak
    const std::map<Day, double> energies = energies_of(recording.meters[output.meter]);
    const auto days = [&](MonthRole role) {
      return days_of(site, result, output, role, temperatures, energies);
    };
    const std::vector<MeterDay> training = days(MonthRole::calibration);
    const auto regression = change_point::fit_regression(training);
    if (!regression) continue;
    assessment::OutputForecasts& forecasts = yardsticks[k].emplace();
    forecasts.months.resize(result.months.size());
    forecasts.blocks.resize(result.months.size());
    take_left_out(result, training, 1, forecasts.months);
    take_left_out(result, training, kBlockMonths, forecasts.blocks);
    const std::vector<MeterDay> later = days(MonthRole::validation);
    if (!later.empty()) {
      const auto unseen = change_point::forecast_months(*regression, later);
      if (unseen) take_unseen(result, output, *unseen, forecasts);
    }
  }
  return yardsticks;
}

}  // namespace recald::daemon
