#include "core/change_point/month_forecast.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>

#include "core/absent.hpp"
#include "core/change_point/day_noise.hpp"
#include "core/change_point/parameters.hpp"

namespace recald::change_point {
namespace {

// One sd of a slope that training could not show: over 30 K, about what a year spans, a meter's use
// doubles or vanishes.
constexpr double kUnseenRange_K = 30.0;

metering::Month month_of(const MeterDay& day) { return day.date.year() / day.date.month(); }

/// The days of one month, and its temperature in the place of those that are not known.
struct MonthDays {
  std::span<const MeterDay> days;
  int known = 0;
  double mean_C = 0.0;
  double sd_C = 0.0;
};

std::vector<MonthDays> by_month(std::span<const MeterDay> days) {
  std::vector<MonthDays> months;
  for (std::size_t begin = 0; begin < days.size();) {
    std::size_t end = begin;
    MonthDays month;
    double squares = 0.0;
    for (; end < days.size() && month_of(days[end]) == month_of(days[begin]); ++end) {
      const double t = days[end].dry_bulb_C;
      if (std::isnan(t)) continue;
      ++month.known;
      const double step = t - month.mean_C;
      month.mean_C += step / month.known;
      squares += step * (t - month.mean_C);
    }
    month.days = days.subspan(begin, end - begin);
    if (month.known == 0) month.mean_C = kAbsent;
    if (month.known > 1) month.sd_C = std::sqrt(squares / (month.known - 1));
    months.push_back(month);
    begin = end;
  }
  return months;
}

bool uses_temperature(const Regression& regression) {
  return std::ranges::any_of(regression.curves,
                             [](const Curve& curve) { return curve.form != Form::no_temperature; });
}

/// kWh/day by which a month may be off because some of its days have no temperature: a stretch
/// without is warmer or colder as a whole.
double unknown_weather_sd(const Regression& regression, const MonthDays& month) {
  double sum = 0.0;
  for (const MeterDay& day : month.days) {
    if (!std::isnan(day.dry_bulb_C)) continue;
    sum += 0.5 * (regression.expected_kWh(day.type, month.mean_C + month.sd_C) -
                  regression.expected_kWh(day.type, month.mean_C - month.sd_C));
  }
  return std::abs(sum) / static_cast<double>(month.days.size());
}

/// What the covariance of months comes from.
struct Errors {
  Eigen::MatrixXd gradient;             ///< (p x m) of the months' means by the parameters.
  Eigen::MatrixXd day_parts_kWh;        ///< (m x days) what one sd of a day adds to its month.
  std::vector<int> day_numbers;         ///< (days) since 1970.
  Eigen::VectorXd month_variance_kWh2;  ///< (m) of what is common to a month's days.
  Eigen::MatrixXd beyond_K;             ///< (2 x m) mean by which days are colder, warmer than any.
};

/// Appends the month's mean, its days and its errors.
void add_month(const Regression& regression, const MonthDays& month, MonthlyForecast& forecast,
               Errors& errors) {
  const auto k = static_cast<Eigen::Index>(forecast.months.size());
  const double count = static_cast<double>(month.days.size());
  const bool needs_temperature = uses_temperature(regression);
  Eigen::VectorXd gradient(errors.gradient.rows());
  int beyond = 0;
  for (const MeterDay& day : month.days) {
    const double t = std::isnan(day.dry_bulb_C) ? month.mean_C : day.dry_bulb_C;
    if (t < regression.coldest_C || t > regression.warmest_C) ++beyond;
    if (t < regression.coldest_C) errors.beyond_K(0, k) += (regression.coldest_C - t) / count;
    if (t > regression.warmest_C) errors.beyond_K(1, k) += (t - regression.warmest_C) / count;
    const double level = regression.expected_kWh(day.type, t);
    forecast.daily_average_kWh(k) += level / count;
    gradient.setZero();
    set_gradient(regression, day.type, t, gradient);
    errors.gradient.col(k) += gradient / count;
    errors.day_parts_kWh(k, std::ssize(errors.day_numbers)) = regression.scatter.at(level) / count;
    errors.day_numbers.push_back(
        static_cast<int>(std::chrono::sys_days{day.date}.time_since_epoch().count()));
  }
  const double mean_sd = errors.day_parts_kWh.row(k).sum();
  const double weather_sd = needs_temperature ? unknown_weather_sd(regression, month) : 0.0;
  errors.month_variance_kWh2(k) =
      regression.month_variance * mean_sd * mean_sd + weather_sd * weather_sd;
  forecast.months.push_back(month_of(month.days.front()));
  forecast.days.push_back(static_cast<int>(month.days.size()));
  forecast.days_beyond.push_back(beyond);
}

}  // namespace

Result<MonthlyForecast> forecast_months(const Regression& regression,
                                        std::span<const MeterDay> days) {
  assert(!days.empty());
  const std::vector<MonthDays> months = by_month(days);
  const auto m = static_cast<Eigen::Index>(months.size());
  MonthlyForecast forecast{.daily_average_kWh = Eigen::VectorXd::Zero(m)};
  Errors errors{Eigen::MatrixXd::Zero(parameters_of(regression), m),
                Eigen::MatrixXd::Zero(m, std::ssize(days)),
                {},
                Eigen::VectorXd::Zero(m),
                Eigen::MatrixXd::Zero(2, m)};
  for (const MonthDays& month : months) {
    if (uses_temperature(regression) && 2 * month.known < std::ssize(month.days)) {
      return failure(ErrorCode::not_enough_data,
                     "the temperature is known on " + std::to_string(month.known) + " of " +
                         std::to_string(month.days.size()) + " days of " +
                         metering::to_string(month_of(month.days.front())) +
                         ", too few to forecast it; leave the month out or provide its weather");
    }
    add_month(regression, month, forecast, errors);
  }
  const double unseen_slope_kWh_K = regression.mean_kWh / kUnseenRange_K;
  const Eigen::MatrixXd covariance =
      unseen_slope_kWh_K * unseen_slope_kWh_K * errors.beyond_K.transpose() * errors.beyond_K +
      errors.gradient.transpose() * regression.parameter_covariance * errors.gradient +
      autoregressive_products(errors.day_parts_kWh, errors.day_numbers, regression.day_correlation);
  forecast.covariance_kWh2 = 0.5 * regression.widening * (covariance + covariance.transpose());
  forecast.covariance_kWh2.diagonal() += regression.widening * errors.month_variance_kWh2;
  return forecast;
}

Result<std::vector<LeftOutMonth>> forecast_left_out_months(std::span<const MeterDay> days,
                                                           int months_together) {
  assert(months_together >= 1);
  std::vector<LeftOutMonth> left_out;
  std::optional<Error> error;
  std::vector<MeterDay> others;
  for (std::size_t begin = 0; begin < days.size();) {
    const metering::Month first = month_of(days[begin]);
    std::size_t end = begin;
    while (end < days.size() &&
           metering::months_between(first, month_of(days[end])) < months_together) {
      ++end;
    }
    others.assign(days.begin(), days.begin() + static_cast<std::ptrdiff_t>(begin));
    others.insert(others.end(), days.begin() + static_cast<std::ptrdiff_t>(end), days.end());
    const auto forecast = fit_regression(others).and_then([&](const Regression& regression) {
      return forecast_months(regression, days.subspan(begin, end - begin));
    });
    begin = end;
    if (!forecast) {
      error = forecast.error();
      continue;
    }
    for (std::size_t k = 0; k < forecast->months.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      left_out.push_back({forecast->months[k], forecast->daily_average_kWh(at),
                          std::sqrt(forecast->covariance_kWh2(at, at))});
    }
  }
  if (left_out.empty() && error) return tl::unexpected(*error);
  return left_out;
}

}  // namespace recald::change_point
