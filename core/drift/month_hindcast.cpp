#include "core/drift/month_hindcast.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <memory>
#include <utility>

#include "core/absent.hpp"
#include "core/model/hourly/hourly_run.hpp"
#include "core/profile/load_band.hpp"

namespace recald::drift {
namespace {

constexpr std::size_t kErrorsMin = 6;
constexpr double kMeasuredMin = 0.9;

/// Mean of what is known; NaN if that is too little.
class MostlyKnownMean {
 public:
  void add(double value) {
    ++all_;
    if (std::isnan(value)) return;
    sum_ += value;
    ++known_;
  }
  [[nodiscard]] double mean() const {
    return known_ > 0 && known_ >= kMeasuredMin * all_ ? sum_ / known_ : kAbsent;
  }
  [[nodiscard]] bool is_empty() const { return all_ == 0; }

 private:
  double sum_ = 0.0;
  double all_ = 0.0;
  double known_ = 0.0;
};

/// How far the meter is from the model in all months but one.
profile::LoadBand band_without(const diagnosis::SiteProblem& problem,
                               const Eigen::ArrayXXd& expected_kW, Eigen::Index output, int month) {
  std::vector<profile::ModelledHour> compared;
  for (std::size_t i = 0; i < problem.drivers->hours.size(); ++i) {
    const model::DriverHour& hour = problem.drivers->hours[i];
    if (hour.month == month) continue;
    const auto row = static_cast<Eigen::Index>(i);
    compared.push_back(
        {hour.day, hour.local_hour, expected_kW(row, output), problem.measured_kW(row, output)});
  }
  return profile::LoadBand{compared};
}

/// One closed month as if it still went on.
struct ReopenedMonth {
  int index;
  metering::TimeSpan span;
  metering::Instant known_until;
  model::Drivers drivers;  ///< With the month before.
  Eigen::ArrayXXd expected_kW;
};

double rest_kW(const ReopenedMonth& month, const profile::LoadBand& band, Eigen::Index output) {
  MostlyKnownMean rest;
  for (std::size_t i = 0; i < month.drivers.hours.size(); ++i) {
    const model::DriverHour& hour = month.drivers.hours[i];
    if (hour.start < month.known_until || hour.start >= month.span.end) continue;
    const auto load =
        band.at(hour.day, hour.local_hour, month.expected_kW(static_cast<Eigen::Index>(i), output));
    rest.add(load ? load->q50_kW : kAbsent);
  }
  return rest.is_empty() ? 0.0 : rest.mean();
}

double error_of(const ReopenedMonth& month, const diagnosis::SiteProblem& problem,
                const profile::LoadBand& band, Eigen::Index output, double mean_kW) {
  MostlyKnownMean so_far;
  MostlyKnownMean whole;
  for (std::size_t i = 0; i < problem.drivers->hours.size(); ++i) {
    const model::DriverHour& hour = problem.drivers->hours[i];
    if (hour.month != month.index) continue;
    const double measured_kW = problem.measured_kW(static_cast<Eigen::Index>(i), output);
    whole.add(measured_kW);
    if (hour.start < month.known_until) so_far.add(measured_kW);
  }
  const double elapsed = metering::in_hours(month.known_until - month.span.begin) /
                         metering::in_hours(month.span.length());
  const double forecast_kW = (so_far.is_empty() ? 0.0 : elapsed * so_far.mean()) +
                             (1.0 - elapsed) * rest_kW(month, band, output);
  return (whole.mean() - forecast_kW) / forecast_scale_kW(forecast_kW, mean_kW);
}

}  // namespace

double forecast_scale_kW(double forecast_kW, double mean_kW) {
  return std::sqrt(std::fmax(std::abs(forecast_kW), 0.2 * std::abs(mean_kW)) * std::abs(mean_kW));
}

std::optional<HindcastBand> band_of_errors(std::span<const double> errors) {
  if (errors.size() < kErrorsMin) return std::nullopt;
  const Eigen::Map<const Eigen::ArrayXd> all{errors.data(), std::ssize(errors)};
  const auto n = static_cast<double>(errors.size());
  const double mean = all.mean();
  const double sd = std::sqrt((all - mean).square().sum() / (n - 1.0));
  const double t = boost::math::quantile(boost::math::students_t{n - 1.0}, 0.95);
  const double half = t * sd * std::sqrt(1.0 + 1.0 / n);
  return HindcastBand{mean - half, mean, mean + half};
}

std::vector<std::vector<double>> hindcast_errors(const diagnosis::SiteProblem& problem,
                                                 const weather::WeatherSeries& weather,
                                                 const ForecastPlace& place,
                                                 std::chrono::seconds elapsed) {
  std::vector<model::MeterMap> maps;
  for (const diagnosis::MeterData& meter : problem.meters) maps.push_back(meter.end_uses);
  std::vector<std::vector<double>> errors(maps.size());
  const auto& months = problem.drivers->months;
  const Eigen::ArrayXXd expected_kW =
      model::hourly::modelled_kW(problem.nominal, problem.drivers, maps);
  for (std::size_t m = 1; m < months.size(); ++m) {
    if (months[m - 1] != metering::previous_month(months[m])) continue;
    const metering::TimeSpan span = place.calendar.month_span(months[m]);
    const auto known_until =
        std::chrono::floor<std::chrono::hours>(std::min(span.begin + elapsed, span.end));
    auto drivers = model::make_drivers(
        {months[m - 1], months[m]}, place.calendar, place.holidays, problem.nominal, problem.loads,
        place.location,
        weather::continued(weather, place.calendar.month_span(months[m - 1]).begin, known_until,
                           span.end),
        model::MissingWeather::assume);
    if (!drivers) continue;  // the weather of the month before was never known
    const auto shared = std::make_shared<const model::Drivers>(*drivers);
    const ReopenedMonth month{static_cast<int>(m), span, known_until, std::move(*drivers),
                              model::hourly::modelled_kW(problem.nominal, shared, maps)};
    for (std::size_t k = 0; k < maps.size(); ++k) {
      const auto output = static_cast<Eigen::Index>(k);
      const auto column = problem.measured_kW.col(output);
      const double mean_kW =
          column.isNaN().select(0.0, column).sum() / static_cast<double>((!column.isNaN()).count());
      const double error = error_of(
          month, problem, band_without(problem, expected_kW, output, month.index), output, mean_kW);
      if (std::isfinite(error)) errors[k].push_back(error);
    }
  }
  return errors;
}

}  // namespace recald::drift
