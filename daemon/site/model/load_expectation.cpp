#include "daemon/site/model/load_expectation.hpp"

#include <algorithm>
#include <utility>

#include "core/model/hourly/hourly_run.hpp"
#include "daemon/site/model/diagnosis_input.hpp"
#include "daemon/site/replay/stored_readings.hpp"

namespace recald::daemon {
namespace {

std::vector<profile::LoadBand> bands_of(const diagnosis::SiteProblem& problem,
                                        std::span<const model::MeterMap> maps) {
  const Eigen::ArrayXXd expected_kW =
      model::hourly::modelled_kW(problem.nominal, problem.drivers, maps);
  std::vector<profile::LoadBand> bands;
  std::vector<profile::ModelledHour> compared(problem.drivers->hours.size());
  for (Eigen::Index k = 0; k < expected_kW.cols(); ++k) {
    for (std::size_t i = 0; i < compared.size(); ++i) {
      const model::DriverHour& hour = problem.drivers->hours[i];
      const auto row = static_cast<Eigen::Index>(i);
      compared[i] = {hour.day, hour.local_hour, expected_kW(row, k), problem.measured_kW(row, k)};
    }
    bands.emplace_back(compared);
  }
  return bands;
}

/// The local months that the span touches, and the one before, whose end warms the building up.
std::vector<metering::Month> months_of(const metering::LocalCalendar& calendar,
                                       const metering::TimeSpan& span) {
  std::vector<metering::Month> months;
  const metering::Month last = calendar.month_of(span.end - std::chrono::seconds{1});
  for (metering::Month month = metering::previous_month(calendar.month_of(span.begin));
       month <= last; month = metering::next_month(month)) {
    months.push_back(month);
  }
  return months;
}

std::vector<LoadExpectation::MonthErrors> month_errors(const OpenSite& site,
                                                       const diagnosis::SiteProblem& problem,
                                                       const weather::WeatherSeries& weather,
                                                       metering::Instant now) {
  const metering::TimeSpan month = site.calendar.month_span(site.calendar.month_of(now));
  const auto errors = drift::hindcast_errors(
      problem, weather, {site.calendar, site.config.holidays, *site.config.location},
      now - month.begin);
  std::vector<LoadExpectation::MonthErrors> all;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const auto measured = problem.measured_kW.col(static_cast<Eigen::Index>(k));
    const double known = static_cast<double>((!measured.isNaN()).count());
    all.push_back(
        {drift::band_of_errors(errors[k]), measured.isNaN().select(0.0, measured).sum() / known});
  }
  return all;
}

}  // namespace

Result<LoadExpectation> LoadExpectation::learn(OpenSite site, metering::Instant now) {
  site.config.period.reset();
  TRY(choose_model(site.config, ModelKind::hourly));
  auto modelled = TRY(load_modelled_site(std::move(site), now));
  const auto problem = TRY(make_site_problem(modelled.site.config, modelled.site.calendar,
                                             modelled.recording, modelled.weather));
  std::vector<model::MeterMap> maps;
  for (const diagnosis::MeterData& meter : problem.meters) maps.push_back(meter.end_uses);
  auto bands = bands_of(problem, maps);
  auto errors = month_errors(modelled.site, problem, modelled.weather.filled.series, now);
  return LoadExpectation{std::move(modelled.site), problem.loads, std::move(maps), std::move(bands),
                         std::move(errors)};
}

Result<std::vector<ExpectedMeter>> LoadExpectation::expect(const metering::TimeSpan& span) const {
  const std::vector<metering::Month> months = months_of(site_.calendar, span);
  const auto live = TRY(open_sensors(site_.config));
  const auto weather =
      TRY(load_weather(site_.config, site_.calendar, {months.front(), months.back()}, live.get()));
  const metering::Instant end = std::min(span.end, weather.filled.series.end());
  auto drivers =
      TRY(model::make_drivers(months, site_.calendar, site_.config.holidays, *site_.config.building,
                              loads_, *site_.config.location,
                              weather::continued(weather.filled.series, weather.filled.series.begin,
                                                 end, site_.calendar.month_span(months.back()).end),
                              model::MissingWeather::assume));
  const auto shared = std::make_shared<const model::Drivers>(std::move(drivers));
  const Eigen::ArrayXXd expected_kW =
      model::hourly::modelled_kW(*site_.config.building, shared, maps_);
  // Weather that ended in an earlier month says nothing of this one.
  const bool is_in_month = end >= site_.calendar.month_span(months.back()).begin;
  std::vector<ExpectedMeter> meters;
  for (std::size_t k = 0; k < bands_.size(); ++k) {
    ExpectedMeter meter{site_.config.model->outputs[k], {}};
    double rest_sum_kW = 0.0;
    int rest_hours = 0;
    for (std::size_t i = 0; i < shared->hours.size(); ++i) {
      const model::DriverHour& hour = shared->hours[i];
      const bool is_rest = hour.start >= end;
      if (hour.start < span.begin && !is_rest) continue;
      const auto band =
          bands_[k].at(hour.day, hour.local_hour,
                       expected_kW(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
      if (!band) continue;
      if (is_rest) {
        rest_sum_kW += band->q50_kW;
        ++rest_hours;
      } else {
        meter.hours.push_back({hour.start, *band});
      }
    }
    if (const auto& error = errors_[k].band; error && rest_hours > 0 && is_in_month) {
      meter.month = {months.back(),      end,        rest_sum_kW / rest_hours,
                     errors_[k].mean_kW, error->low, error->middle,
                     error->high};
    }
    meters.push_back(std::move(meter));
  }
  return meters;
}

}  // namespace recald::daemon
