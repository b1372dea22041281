#include "daemon/site/results/report_of.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "adapters/views/calibration/calibration_words.hpp"
#include "adapters/views/diagnosis/diagnosis_words.hpp"
#include "adapters/views/frame/provenance.hpp"
#include "core/absent.hpp"
#include "core/display/id_words.hpp"
#include "core/display/warning.hpp"
#include "core/regression/fit_quality.hpp"
#include "daemon/site/model/meter_rates.hpp"
#include "daemon/site/results/report_parts.hpp"

namespace recald::daemon {
namespace {

using assessment::AssessedCalibration;

/// An output that the page shows, as it calls it.
struct ShownOutput {
  std::size_t index;  ///< Into the result's outputs.
  std::string label;  ///< "Chilled water"
};

views::ParameterResult parameter_of(const AssessedCalibration& result, std::size_t j,
                                    std::string label) {
  views::ParameterResult shown{.label = std::move(label),
                               .prior = result.parameters[j].prior,
                               .summary = result.calibration.parameters[j],
                               .draws = {}};
  for (const calibration::ChainDraws& chain : result.calibration.chains) {
    const auto column = chain.theta.col(static_cast<Eigen::Index>(j));
    shown.draws.insert(shown.draws.end(), column.begin(), column.end());
  }
  return shown;
}

bool is_peak(const assessment::OutputCalibration& output) { return output.unit == "kW"; }

/// The months of the result, and those that belong to no period: they still show what was measured.
std::vector<views::OutputMonth> months_of(const Recording& recording, const SiteCalibration& result,
                                          const assessment::OutputCalibration& output) {
  const MeterRecord& record = recording.meters[output.meter];
  std::vector<views::OutputMonth> months;
  for (std::size_t i = 0; i < result.months.size(); ++i) {
    const metering::Month month = result.months[i];
    const auto figure = std::ranges::find(record.figures, month, &metering::MonthlyFigure::month);
    months.push_back(
        {.figure = figure != record.figures.end()
                       ? *figure
                       : metering::MonthlyFigure{.month = month, .daily_average_kWh = kAbsent},
         .role = result.roles[i],
         .box = output.assessment.boxes[i],
         .forecast = output.assessment.forecast.months[i]});
  }
  for (const metering::MonthlyFigure& figure : record.figures) {
    if (std::ranges::find(result.months, figure.month) != result.months.end()) continue;
    months.push_back({.figure = figure, .box = {}, .forecast = {}});
  }
  for (views::OutputMonth& month : months) {
    month.flagged_different = is_site_different(recording, month.figure.month);
  }
  std::ranges::sort(months, {}, [](const views::OutputMonth& month) { return month.figure.month; });
  return months;
}

views::DayTypeProfile day_profile_of(const model::ElectricityProfile& profile, model::DayType day,
                                     std::string label) {
  views::DayTypeProfile shown{.label = std::move(label)};
  const auto hours = [&](auto value) {
    views::HourlyProfile kW{};
    for (int hour = 0; hour < 24; ++hour) kW[static_cast<std::size_t>(hour)] = value(hour);
    return kW;
  };
  const auto& loads = profile.loads;
  const auto standing = [&](int hour) {
    return std::min(profile.standby_kW, loads.plugs_kW.at(day, hour));
  };
  shown.parts = {
      {"Exterior", hours([&](int) { return profile.known.exterior_kW; })},
      {"Standby", hours(standing)},
      {"Plug loads", hours([&](int h) { return loads.plugs_kW.at(day, h) - standing(h); })},
      {"Lights", hours([&](int h) { return loads.lights_kW.at(day, h); })},
      {"Fans and pumps", hours([&](int h) { return profile.known.fans_and_pumps_kW.at(day, h); })}};
  shown.measured_mean_kW = hours([&](int h) { return profile.measured_kW.at(day, h); });
  return shown;
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

/// "CV(RMSE) 3.4 % and NMBE +0.7 %, 11 of 12 inside the 90 % band"
std::string fit_words(const assessment::ForecastFit& fit) {
  return fmt::format("CV(RMSE) {} and NMBE {:+.1f} %, {} of {} inside the 90 % band",
                     percent(fit.metrics->cvrmse), 100.0 * fit.metrics->nmbe_sim_minus_meas,
                     fit.scores->inside_90, fit.scores->months);
}

/// Forecast, yardstick and the model alone, of the months that say most: unseen ones where there
/// are any, else blocks left out. Empty where nothing can be compared.
std::string forecast_sentence(const std::string& meter, const assessment::OutputAssessment& a) {
  const bool has_unseen = a.forecast.validation.metrics.has_value();
  const auto fit_of = [&](const assessment::ForecastAssessment& forecast) {
    return has_unseen ? forecast.validation : forecast.blocks;
  };
  const assessment::ForecastFit fit = fit_of(a.forecast);
  if (!fit.metrics || !fit.scores) return "";
  std::string text = fmt::format(
      "{}: forecast of {}: {}", meter,
      has_unseen ? "months it has not seen" : "each three months from the others", fit_words(fit));
  if (a.yardstick) {
    const assessment::ForecastFit yardstick = fit_of(*a.yardstick);
    if (yardstick.metrics) {
      text += fmt::format(". A regression of the meter's days on temperature: CV(RMSE) {}",
                          percent(yardstick.metrics->cvrmse));
    }
  }
  return text + ".";
}

std::string model_sentence(const std::string& meter, const assessment::OutputAssessment& a) {
  const auto& before = a.before.validation ? a.before.validation : a.before.calibration;
  const auto& after = a.after.validation ? a.after.validation : a.after.calibration;
  if (!before || !after) return "";
  return fmt::format(
      "{}, the model alone, which retrofits and diagnosis use: NMBE {:+.1f} % before calibration "
      "and "
      "{:+.1f} % after; CV(RMSE) {} and {}.",
      meter, 100.0 * before->nmbe_sim_minus_meas, 100.0 * after->nmbe_sim_minus_meas,
      percent(before->cvrmse), percent(after->cvrmse));
}

/// What stands first, and behind it the sentences that it is drawn from. Peaks come first only
/// where there is nothing else.
void add_answer(const AssessedCalibration& result, const std::vector<ShownOutput>& shown,
                views::ReportData& data) {
  const bool has_peaks_alone = std::ranges::all_of(
      shown, [&](const ShownOutput& output) { return is_peak(result.outputs[output.index]); });
  std::vector<views::FittedMeter> meters;
  std::vector<std::string> models;
  for (const auto& [index, meter] : shown) {
    const assessment::OutputCalibration& output = result.outputs[index];
    if (!is_peak(output) || has_peaks_alone) {
      auto fitted = views::fitted_meter(meter, output.assessment);
      if (fitted) meters.push_back(std::move(*fitted));
    }
    if (auto text = forecast_sentence(meter, output.assessment); !text.empty()) {
      data.headlines.push_back(std::move(text));
    }
    if (auto text = model_sentence(meter, output.assessment); !text.empty()) {
      models.push_back(std::move(text));
    }
    // What was not fitted is judged by no limit for fitted models.
    if (const auto& after = output.assessment.after.calibration; after && output.calibrated) {
      data.verdicts.push_back({meter, assessment::guideline14_verdict(*after)});
    }
  }
  data.headlines.insert(data.headlines.end(), models.begin(), models.end());
  data.first = views::calibration_first_screen(meters, result.calibration.converged);
  data.asks_for_diagnosis = views::asks_for_diagnosis(meters);
}

/// Of the months that no model has seen: their mean, as sums of money and CO2.
void add_forecast_cost(const SiteConfig& site, const MeterRecord& record,
                       const SiteCalibration& result, const assessment::OutputCalibration& output,
                       views::ReportData& data) {
  const auto& unseen = output.assessment.forecast.unseen_mean;
  if (!unseen) return;
  views::ForecastCost cost{.meter = display::meter_label(record.meter.id),
                           .first = {},
                           .last = {},
                           .months = 0,
                           .money = {},
                           .emissions_t = {}};
  double days = 0.0;
  for (std::size_t i = 0; i < result.months.size(); ++i) {
    if (result.roles[i] != assessment::MonthRole::validation || std::isnan(output.measured[i])) {
      continue;
    }
    if (cost.months++ == 0) cost.first = result.months[i];
    cost.last = result.months[i];
    days += result.month_days[i];
  }
  const auto sum = [&](double rate) {
    const assessment::MonthForecast& f = unseen->forecast;
    const double factor = rate * days;
    return views::ForecastSum{factor * f.mean, factor * f.q05, factor * f.q95,
                              factor * unseen->measured};
  };
  const tariff::Rates rates = rates_of(site, record);
  if (rates.per_kWh) cost.money = sum(*rates.per_kWh);
  if (rates.emissions_kg_per_kWh) cost.emissions_t = sum(1e-3 * *rates.emissions_kg_per_kWh);
  if (cost.money || cost.emissions_t) data.forecast_costs.push_back(std::move(cost));
}

void add_not_known(const AssessedCalibration& result, const std::vector<ShownOutput>& shown,
                   views::ReportData& data) {
  for (const auto& [index, label] : shown) {
    const std::string& because = result.outputs[index].not_fitted_because;
    if (!because.empty()) data.not_known.push_back(label + " is not fitted. " + because);
  }
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    if (assessment::is_identified(result, j)) continue;
    const calibration::Summary& s = result.calibration.parameters[j];
    data.not_known.push_back(
        fmt::format("{}: not identified. The measurements narrow its variance by {:.0f} %, and "
                    "could by {:.0f} % "
                    "at most; its value is mostly what was assumed.",
                    data.parameters[j].label, 100.0 * std::max(s.contraction, 0.0),
                    100.0 * assessment::contraction_max(result, j)));
  }
  data.not_known.emplace_back(
      "A parameter that fits is not a parameter that was measured: another combination of values, "
      "or an effect that the model lacks, may explain the same months.");
  data.not_known.emplace_back(
      "The discrepancy between model and building is known in size, not in cause, and is not "
      "carried into other operating conditions.");
}

/// What a page says of any calibration, wherever its model came from. Its parameters are there.
void add_calibration(const AssessedCalibration& result, const std::vector<ShownOutput>& shown,
                     views::ReportData& data) {
  add_answer(result, shown, data);
  if (!result.calibration.converged) {
    data.notices.push_back({views::Severity::failure,
                            "The sampler has not converged to the limits set for it (R-hat, "
                            "effective sample size): treat intervals as rough."});
  }
  for (const auto* warnings : {&result.alarms, &result.warnings}) {
    for (const display::Warning& warning : *warnings) {
      data.notices.push_back(notice_of(views::Severity::warning, warning));
    }
  }
  add_not_known(result, shown, data);
}

/// Outputs of a design as people say them: "Steam" and "Steam peak" of "steam_daily_kWh" and
/// "steam_peak_kW". A name of another kind stays as it is.
std::vector<ShownOutput> shown_of(const DesignCalibration& result) {
  std::vector<std::string> names;
  for (const assessment::OutputCalibration& output : result.outputs) names.push_back(output.name);
  std::vector<ShownOutput> shown;
  for (std::size_t k = 0; k < names.size(); ++k) shown.push_back({k, names[k]});
  for (const regression::MeterOutputs& meter : regression::group_by_meter(names)) {
    if (meter.consumption >= 0) {
      const auto k = static_cast<std::size_t>(meter.consumption);
      if (meter.meter.empty()) shown[k].label = "Consumption";
      if (!meter.meter.empty() && meter.meter != names[k])
        shown[k].label = display::meter_label(meter.meter);
    }
    if (meter.peak >= 0) {
      shown[static_cast<std::size_t>(meter.peak)].label =
          meter.meter.empty() ? "Peak demand" : display::meter_label(meter.meter) + " peak";
    }
  }
  return shown;
}

/// What the folder knows of a month: a figure, and nothing of the readings behind it.
views::OutputMonth month_of(const DesignCalibration& result,
                            const assessment::OutputCalibration& output, std::size_t i) {
  views::OutputMonth shown{.figure = {.daily_average_kWh = output.measured[i],
                                      .coverage = kAbsent,
                                      .filled_share = kAbsent,
                                      .usable = !std::isnan(output.measured[i])},
                           .role = result.roles[i],
                           .box = output.assessment.boxes[i],
                           .forecast = output.assessment.forecast.months[i]};
  if (is_peak(output) && shown.figure.usable) {
    shown.figure.peak = metering::PeakDemand{.kW = output.measured[i]};
  }
  if (const auto month = metering::parse_month(result.month_names[i])) {
    shown.figure.month = *month;
  } else {
    shown.number = result.month_names[i];
  }
  return shown;
}

}  // namespace

views::ReportData report_of(const SiteConfig& site, const metering::LocalCalendar& calendar,
                            const Recording& recording, const SiteCalibration& result,
                            const RunFacts& facts, std::string generated_at) {
  views::ReportData data{.title = "Calibration of " + site.name,
                         .generated_at = std::move(generated_at),
                         .site = site_line_of(site),
                         .calendar = calendar,
                         .provenance = views::sampled_provenance_of(facts),
                         .units = site.units,
                         .currency = site.tariff.currency};
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    data.parameters.push_back(parameter_of(result, j, result.parameters[j].label));
  }
  std::vector<ShownOutput> shown;
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    const assessment::OutputCalibration& output = result.outputs[k];
    const bool is_of_building = facts_of(result.model).is_of_building;
    // Peaks that are no evidence are shown as measured, beside each other.
    if (is_peak(output) && is_of_building) continue;
    shown.push_back({k, display::meter_label(recording.meters[output.meter].meter.id) +
                            (is_peak(output) ? " peak" : "")});
    data.outputs.push_back({.label = shown.back().label,
                            .is_peak = is_peak(output),
                            .units = display::meter_units(site.units, output.utility),
                            .months = months_of(recording, result, output),
                            .assessment = output.assessment});
    if (!is_peak(output))
      add_forecast_cost(site, recording.meters[output.meter], result, output, data);
  }
  add_calibration(result, shown, data);
  if (facts_of(result.model).is_of_building)
    data.not_known.emplace_back(
        facts_of(result.model).has_peaks
            ? "Peak demand is shown as measured; the model's own peaks are in calibration.json."
            : "Peak demand is measured only. The monthly model has no peaks.");
  for (const MeterRecord& record : recording.meters) {
    for (metering::DataFinding finding : record.findings) {
      finding.meter = display::meter_label(finding.meter);
      data.findings.push_back(std::move(finding));
    }
    data.peaks.push_back({.meter = display::meter_label(record.meter.id),
                          .units = display::meter_units(site.units, record.meter.utility),
                          .months = record.figures});
    data.loads.push_back(load_of(record, site.units));
  }
  if (!facts_of(result.model).is_of_building) return data;  // no profile was read off a meter
  using enum model::DayType;
  data.profile = {
      .day_types = {day_profile_of(result.profile, workday, "Working day"),
                    day_profile_of(result.profile, saturday, "Saturday"),
                    day_profile_of(result.profile, sunday_or_holiday, "Sunday and holiday")},
      .check_sentence = result.profile.check.words};
  return data;
}

views::ReportData report_of(const FinishedDesign& done, std::string generated_at) {
  const DesignCalibration& result = done.calibration;
  views::ReportData data{.title = "Calibration of " + done.name,
                         .generated_at = std::move(generated_at),
                         .site = {.id = {}, .name = done.name, .time_zone = {}},
                         .provenance = views::sampled_provenance_of(done.facts)};
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    data.parameters.push_back(parameter_of(result, j, result.parameters[j].name));
  }
  const std::vector<ShownOutput> shown = shown_of(result);
  const std::vector<std::size_t> in_order = in_order_of_time(result.months);
  for (const auto& [index, label] : shown) {
    const assessment::OutputCalibration& output = result.outputs[index];
    views::OutputResult& page = data.outputs.emplace_back(views::OutputResult{
        .label = label, .is_peak = is_peak(output), .months = {}, .assessment = output.assessment});
    if (!page.is_peak) page.units.daily = display::Unit{output.unit};
    for (const std::size_t i : in_order) page.months.push_back(month_of(result, output, i));
  }
  add_calibration(result, shown, data);
  // What the effects library looks for, it looks for at a site.
  data.asks_for_diagnosis = false;
  return data;
}

}  // namespace recald::daemon
