#include "daemon/site/results/meters_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "adapters/views/diagnosis/diagnosis_words.hpp"
#include "adapters/views/frame/provenance.hpp"
#include "adapters/views/meters/meters_words.hpp"
#include "core/absent.hpp"
#include "core/change_point/regression.hpp"
#include "core/display/id_words.hpp"
#include "core/display/prose.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"
#include "core/tariff/tariff.hpp"
#include "daemon/site/calibrate/meter_days.hpp"
#include "daemon/site/calibrate/meter_forecast.hpp"
#include "daemon/site/replay/stored_readings.hpp"
#include "daemon/site/results/report_parts.hpp"

namespace recald::daemon {
namespace {

using assessment::MonthRole;
using assessment::OutputCalibration;
using change_point::Regression;
using metering::Day;
using metering::Month;
using model::DayType;

const OutputCalibration* output_of(const SiteCalibration* forecast, std::size_t meter) {
  if (forecast == nullptr) return nullptr;
  const auto found = std::ranges::find(forecast->outputs, meter, &OutputCalibration::meter);
  return found == forecast->outputs.end() ? nullptr : &*found;
}

std::vector<views::OutputMonth> months_of(const MeterRecord& record,
                                          const SiteCalibration* forecast,
                                          const OutputCalibration* output) {
  std::vector<views::OutputMonth> months;
  for (const metering::MonthlyFigure& figure : record.figures) {
    views::OutputMonth& month = months.emplace_back(views::OutputMonth{.figure = figure});
    month.flagged_different = metering::is_different(record.level_changes, figure.month);
    if (output == nullptr) continue;
    const auto place = std::ranges::find(forecast->months, figure.month);
    if (place == forecast->months.end()) continue;
    const auto i = static_cast<std::size_t>(place - forecast->months.begin());
    month.role = forecast->roles[i];
    month.forecast = output->assessment.forecast.months[i];
  }
  return months;
}

std::vector<double> base_loads_kW(const MeterRecord& record, const model::Holidays& holidays) {
  std::vector<double> bases;
  for (const metering::MonthlyFigure& figure : record.figures) {
    const auto hours = record.hours.find(figure.month);
    bases.push_back(hours == record.hours.end()
                        ? kAbsent
                        : profile::load_shape(hours->second, holidays).base_kW);
  }
  return bases;
}

/// Of the last twelve months that have hours: an older building may be another one.
profile::LoadShape shape_of(const MeterRecord& record, const model::Holidays& holidays) {
  std::vector<model::HourlyLoad> loads;
  int months = 0;
  for (auto it = record.hours.rbegin(); it != record.hours.rend() && months < 12; ++it, ++months) {
    loads.insert(loads.end(), it->second.begin(), it->second.end());
  }
  return profile::load_shape(loads, holidays);
}

/// Kinds of day that share base load and curve, as one name: "Saturdays, Sundays and holidays".
std::string kinds_text(const std::vector<DayType>& kinds) {
  if (kinds.size() == model::kDayTypes) return "All days";
  const bool with_sundays = kinds.back() == DayType::sunday_or_holiday;
  if (kinds.size() == 2) {
    if (kinds.front() == DayType::saturday) return "Saturdays, Sundays and holidays";
    return with_sundays ? "Working days, Sundays and holidays" : "Working days and Saturdays";
  }
  if (with_sundays) return "Sundays and holidays";
  return kinds.front() == DayType::saturday ? "Saturdays" : "Working days";
}

/// Kinds of day by base load and curve, in order of their first.
std::vector<std::vector<DayType>> alike_kinds(const Regression& regression) {
  std::map<std::pair<int, std::size_t>, std::vector<DayType>> alike;
  for (std::size_t kind = 0; kind < model::kDayTypes; ++kind) {
    alike[{regression.base_number[kind], regression.curve_of[kind]}].push_back(
        static_cast<DayType>(kind));
  }
  std::vector<std::vector<DayType>> groups;
  for (auto& [key, kinds] : alike) groups.push_back(std::move(kinds));
  std::ranges::sort(groups);
  return groups;
}

void add_rows(const Regression& regression, views::TemperatureFit& fit) {
  for (const std::vector<DayType>& kinds : alike_kinds(regression)) {
    const auto kind = static_cast<std::size_t>(kinds.front());
    const change_point::Curve& curve = regression.curves[regression.curve_of[kind]];
    const bool heats = std::isfinite(curve.heating_balance_C);
    const bool cools = std::isfinite(curve.cooling_balance_C);
    fit.rows.push_back({.days = kinds_text(kinds),
                        .base_kWh = regression.base_kWh[kind],
                        .heating_slope_kWh_K = heats ? curve.heating_slope_kWh_K : kAbsent,
                        .heating_balance_C = curve.heating_balance_C,
                        .cooling_slope_kWh_K = cools ? curve.cooling_slope_kWh_K : kAbsent,
                        .cooling_balance_C = curve.cooling_balance_C});
    views::TemperatureLine& line =
        fit.lines.emplace_back(views::TemperatureLine{kinds.front(), {}});
    for (const double at : {regression.coldest_C, curve.heating_balance_C, curve.cooling_balance_C,
                            regression.warmest_C}) {
      if (!(regression.coldest_C <= at && at <= regression.warmest_C)) continue;
      line.points.push_back({at, regression.expected_kWh(kinds.front(), at)});
    }
  }
}

std::string trust_words(const assessment::ForecastAssessment& forecast) {
  const bool unseen = forecast.validation.metrics.has_value();
  const assessment::ForecastFit& fit = unseen ? forecast.validation : forecast.blocks;
  if (!fit.metrics || !fit.scores) return "";
  return fmt::format(
      "Forecasting {}, it was off by {:.1f}\u00a0% on average (CV(RMSE)), its sum by "
      "{:+.1f}\u00a0%; {} of {} months lay inside the 90\u00a0% band.",
      unseen ? "the months that it had not seen" : "each three months from the others",
      100.0 * fit.metrics->cvrmse, 100.0 * fit.metrics->nmbe_sim_minus_meas, fit.scores->inside_90,
      fit.scores->months);
}

/// What every meter's regression needs.
struct Weather {
  const SiteConfig& site;
  const SiteCalibration& forecast;
  std::map<Day, double> dry_bulbs_C;
};

/// @return or why there is none, as a sentence.
tl::expected<views::TemperatureFit, std::string> temperature_of(const Weather& weather,
                                                                const MeterRecord& record,
                                                                const OutputCalibration& output) {
  const std::map<Day, double> energies = daily_energies_kWh(record);
  const auto days = [&](MonthRole role) {
    return meter_days(weather.site.holidays, weather.forecast, output, role, weather.dry_bulbs_C,
                      energies);
  };
  const std::vector<change_point::MeterDay> fitted = days(MonthRole::calibration);
  const std::string label = display::meter_label(record.meter.id);
  const auto regression = change_point::fit_regression(fitted);
  if (!regression) return tl::unexpected(label + ": " + regression.error().message + ".");
  if (!regression->no_temperature_because.empty()) {
    return tl::unexpected(
        label + ": " +
        display::with_temperatures_in(weather.site.units, regression->no_temperature_because) +
        ".");
  }
  views::TemperatureFit fit{
      .sentence = change_point::describe(
          *regression, display::meter_units(weather.site.units, record.meter.utility),
          display::unit_of(weather.site.units, "degC")),
      .trust = trust_words(output.assessment.forecast)};
  add_rows(*regression, fit);
  const auto add_days = [&](const std::vector<change_point::MeterDay>& all, bool unseen) {
    for (const change_point::MeterDay& day : all) {
      if (!std::isfinite(day.energy_kWh) || !std::isfinite(day.dry_bulb_C)) continue;
      fit.days.push_back({day.date, day.type, day.dry_bulb_C, day.energy_kWh, unseen});
    }
  };
  add_days(fitted, false);
  add_days(days(MonthRole::validation), true);
  return fit;
}

void add_meter(const SiteConfig& site, const MeterRecord& record, std::size_t meter,
               const MeterForecasts& forecasts, const std::optional<Weather>& weather,
               views::MetersData& data) {
  const OutputCalibration* output = output_of(forecasts.forecast, meter);
  views::MeterPart part{.year = views::compare_years(record.figures, record.level_changes),
                        .month_base_kW = base_loads_kW(record, site.holidays),
                        .shape = shape_of(record, site.holidays),
                        .temperature = {},
                        .no_temperature_because = forecasts.lacking};
  const std::string label = display::meter_label(record.meter.id);
  if (weather && output != nullptr) {
    auto fit = temperature_of(*weather, record, *output);
    if (fit) {
      part.temperature = std::move(*fit);
    } else {
      part.no_temperature_because = fit.error();
    }
  } else if (weather) {
    part.no_temperature_because =
        label + ": too few of its days are usable to be regressed on the temperature.";
  }
  const display::MeterUnits units = display::meter_units(site.units, record.meter.utility);
  data.meters.push_back(std::move(part));
  data.common.outputs.push_back({.label = label,
                                 .units = units,
                                 .months = months_of(record, forecasts.forecast, output),
                                 .assessment = {}});
  data.common.peaks.push_back({.meter = label, .units = units, .months = record.figures});
  data.common.loads.push_back(load_of(record, site.units));
  for (metering::DataFinding finding : record.findings) {
    finding.meter = label;
    data.common.findings.push_back(std::move(finding));
  }
  for (const metering::LevelChange& change : record.level_changes) {
    data.changes.push_back(views::change_words(label, change));
  }
}

/// Every month of a meter that has a figure.
views::MeterCosts costs_of(const SiteConfig& site, const MeterRecord& record) {
  views::MeterCosts costs{display::meter_label(record.meter.id), {}};
  const std::vector<model::HourlyLoad> none;
  for (const metering::MonthlyFigure& figure : record.figures) {
    if (!figure.usable) continue;
    const auto hours = record.hours.find(figure.month);
    costs.months.push_back(
        {figure.month,
         tariff::bill_of(site.tariff, record.meter.utility, figure,
                         hours == record.hours.end() ? none : hours->second, site.holidays)});
  }
  return costs;
}

/// Meters whose utility the site file prices or whose emissions it gives.
void add_costs(const SiteConfig& site, const Recording& recording, std::size_t shown,
               views::ReportData& data) {
  data.currency = site.tariff.currency;
  for (std::size_t meter = 0; meter < shown; ++meter) {
    const MeterRecord& record = recording.meters[meter];
    if (!site.tariff.prices_of(record.meter.utility) &&
        !site.tariff.emissions_of(record.meter.utility)) {
      continue;
    }
    data.costs.push_back(costs_of(site, record));
  }
}

std::string no_changes_words(const Recording& recording) {
  const bool any_second_year = std::ranges::any_of(recording.meters, [](const MeterRecord& record) {
    return !record.figures.empty() && metering::months_between(record.figures.front().month,
                                                               record.figures.back().month) >= 12;
  });
  return any_second_year
             ? "No meter has changed its level against the same months of the year before."
             : "That shows against the same months of the year before, and no meter has more than "
               "one year yet.";
}

views::FirstScreen first_of(const Recording& recording, const SiteCalibration* forecast,
                            const views::MetersData& data) {
  std::vector<views::MeterStory> stories;
  for (std::size_t i = 0; i < data.meters.size(); ++i) {
    const OutputCalibration* output = output_of(forecast, i);
    stories.push_back(
        {.label = data.common.outputs[i].label,
         .units = data.common.outputs[i].units,
         .year = data.meters[i].year,
         .changes = recording.meters[i].level_changes,
         .unseen = output == nullptr ? std::nullopt : output->assessment.forecast.unseen_mean,
         .base_share = data.meters[i].shape.base_share});
  }
  return views::first_screen_of(stories);
}

void add_notices(const Recording& recording, const SiteCalibration* forecast,
                 views::MetersData& data) {
  using views::Severity;
  if (forecast == nullptr) {
    for (const std::string& note : recording.notes) {
      data.common.notices.push_back(notice_of(Severity::warning, display::warning_of(note)));
    }
    return;
  }
  for (const display::Warning& warning : forecast->warnings) {
    data.common.notices.push_back(notice_of(Severity::warning, warning));
  }
  if (!forecast->not_calibrated_because.empty()) {
    data.common.notices.push_back({Severity::info, forecast->not_calibrated_because});
  }
}

/// The site's own period, or all months that any meter can use. Absent: there is none.
std::optional<PeriodConfig> period_of(const SiteConfig& site, const Recording& recording) {
  if (site.period) return site.period;
  std::set<Month> months;
  for (const MeterRecord& record : recording.meters) {
    for (const metering::MonthlyFigure& figure : record.figures) {
      if (figure.usable) months.insert(figure.month);
    }
  }
  if (months.empty()) return std::nullopt;
  PeriodConfig period{{*months.begin(), *months.rbegin()}, {}};
  if (metering::months_between(period.calibration.first, period.calibration.last) >= 23) {
    const Month split = period.calibration.last - std::chrono::months{11};
    period.validation = {split, period.calibration.last};
    period.calibration.last = metering::previous_month(split);
  }
  return period;
}

Result<SiteWeather> weather_of(const OpenSite& site) {
  const auto sensors = TRY(open_sensors(site.config));
  return load_weather(site.config, site.calendar, whole_period(site.config), sensors.get());
}

}  // namespace

views::MetersData meters_report_of(const SiteConfig& site, const metering::LocalCalendar& calendar,
                                   const Recording& recording, const MeterForecasts& forecasts,
                                   const RunFacts& facts, std::string generated_at) {
  views::MetersData data;
  data.common = {.title = "Meters of " + site.name,
                 .generated_at = std::move(generated_at),
                 .site = site_line_of(site),
                 .calendar = calendar,
                 .provenance = views::provenance_of(facts),
                 .units = site.units};
  std::optional<Weather> weather;
  if (forecasts.forecast != nullptr) {
    weather.emplace(
        Weather{site, *forecasts.forecast,
                daily_dry_bulbs_C(calendar, *forecasts.weather, forecasts.forecast->months)});
  }
  const std::size_t shown = std::min(recording.meters.size(), kMetersOnPage);
  for (std::size_t meter = 0; meter < shown; ++meter) {
    add_meter(site, recording.meters[meter], meter, forecasts, weather, data);
  }
  add_costs(site, recording, shown, data.common);
  if (const std::size_t more = recording.meters.size() - shown; more > 0) {
    data.left_out = fmt::format("The site has {} more meter{}; months.csv has the figures of all.",
                                more, more == 1 ? "" : "s");
  }
  data.no_changes = no_changes_words(recording);
  data.first = first_of(recording, forecasts.forecast, data);
  add_notices(recording, forecasts.forecast, data);
  return data;
}

Result<std::string> render_meters_of(const OpenSite& site, const Recording& recording,
                                     std::string generated_at) {
  OpenSite read = site;
  auto facts = facts_of(read.config);
  if (!facts) {
    read.config.weather.reset();  // a weather file that is not there yet is no fault of the meters
    facts = facts_of(read.config);
  }
  if (!facts) return tl::unexpected(facts.error());
  const auto rendered = [&](const MeterForecasts& forecasts) {
    return views::render_meters(meters_report_of(site.config, site.calendar, recording, forecasts,
                                                 *facts, std::move(generated_at)));
  };
  if (!site.config.weather || recording.meters.size() > kMetersOnPage) return rendered({});
  const auto lacking = [&](const std::string& why) {
    return rendered({nullptr, nullptr, fmt::format("Nothing is said of the weather: {}.", why)});
  };
  if (!read.config.weather) return lacking("its file cannot be read");
  read.config.period = period_of(site.config, recording);
  if (!read.config.period) return rendered({});
  const auto weather = weather_of(read);
  if (!weather) return lacking(weather.error().message);
  facts->weather_values = to_string(weather->values);
  const auto forecast = forecast_meters(read.config, site.calendar, recording, *weather, "");
  if (!forecast) return lacking(forecast.error().message);
  return rendered({&*weather, &*forecast, ""});
}

}  // namespace recald::daemon
