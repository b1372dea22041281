#include "daemon/site/calibrate/yardstick.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/absent.hpp"
#include "core/assessment/given_data.hpp"
#include "core/change_point/month_forecast.hpp"
#include "core/change_point/regression.hpp"
#include "daemon/site/calibrate/meter_days.hpp"

namespace recald::daemon {
namespace {

using assessment::Forecast;
using assessment::MonthRole;
using change_point::MeterDay;
using metering::Day;
using metering::Month;

constexpr int kBlockMonths = 3;

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
  const std::map<Day, double> temperatures = daily_dry_bulbs_C(calendar, weather, result.months);
  std::vector<std::optional<assessment::OutputForecasts>> yardsticks(result.outputs.size());
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    const assessment::OutputCalibration& output = result.outputs[k];
    if (output.unit == "kW") continue;  // days say nothing of a month's peak
    const std::map<Day, double> energies = daily_energies_kWh(recording.meters[output.meter]);
    const auto days = [&](MonthRole role) {
      return meter_days(site.holidays, result, output, role, temperatures, energies);
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
