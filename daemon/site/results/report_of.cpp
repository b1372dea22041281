#include "daemon/site/results/report_of.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/absent.hpp"
#include "daemon/site/results/calibration_words.hpp"
#include "daemon/site/results/diagnosis_words.hpp"
#include "daemon/site/results/report_parts.hpp"

namespace recald::daemon {
namespace {

report::ParameterResult parameter_of(const SiteCalibration& result, std::size_t j) {
  report::ParameterResult shown{.label = std::string{result.definitions[j]->label},
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
std::vector<report::OutputMonth> months_of(const Recording& recording,
                                           const SiteCalibration& result,
                                           const assessment::OutputCalibration& output) {
  const MeterRecord& record = recording.meters[output.meter];
  std::vector<report::OutputMonth> months;
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
  for (report::OutputMonth& month : months) {
    month.flagged_different = is_site_different(recording, month.figure.month);
  }
  std::ranges::sort(months, {},
                    [](const report::OutputMonth& month) { return month.figure.month; });
  return months;
}

report::DayTypeProfile day_profile_of(const profile::ElectricityProfile& profile,
                                      model::DayType day, std::string label) {
  report::DayTypeProfile shown{.label = std::move(label)};
  const auto hours = [&](auto value) {
    report::HourlyProfile kW{};
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

/// What stands first, and behind it the sentences that it is drawn from.
void add_answer(const Recording& recording, const SiteCalibration& result,
                report::ReportData& data) {
  std::vector<FittedMeter> meters;
  std::vector<std::string> models;
  for (const assessment::OutputCalibration& output : result.outputs) {
    if (is_peak(output)) continue;
    const std::string meter = meter_label(recording.meters[output.meter].meter.id);
    if (auto fitted = fitted_meter(meter, output.assessment)) meters.push_back(std::move(*fitted));
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
  data.first = calibration_first_screen(meters, result.calibration.converged);
  data.asks_for_diagnosis = asks_for_diagnosis(meters);
}

void add_not_known(const Recording& recording, const SiteCalibration& result,
                   report::ReportData& data) {
  for (const assessment::OutputCalibration& output : result.outputs) {
    if (is_peak(output) || output.not_fitted_because.empty()) continue;
    data.not_known.push_back(fmt::format("{} is not fitted. {}",
                                         meter_label(recording.meters[output.meter].meter.id),
                                         output.not_fitted_because));
  }
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    if (assessment::is_identified(result, j)) continue;
    const calibration::Summary& s = result.calibration.parameters[j];
    data.not_known.push_back(
        fmt::format("{}: not identified. The measurements narrow its variance by {:.0f} %, and "
                    "could by {:.0f} % "
                    "at most; its value is mostly what was assumed.",
                    result.definitions[j]->label, 100.0 * std::max(s.contraction, 0.0),
                    100.0 * assessment::contraction_max(result, j)));
  }
  data.not_known.emplace_back(
      "A parameter that fits is not a parameter that was measured: another combination of values, "
      "or an effect that the model lacks, may explain the same months.");
  data.not_known.emplace_back(
      facts_of(result.model).has_peaks
          ? "Peak demand is shown as measured; how the model tells it stands in calibration.json."
          : "Peak demand is measured only. The monthly model has no peaks.");
  data.not_known.emplace_back(
      "The discrepancy between model and building is known in size, not in cause, and is not "
      "carried into other operating conditions.");
}

}  // namespace

report::ReportData report_of(const SiteConfig& site, const metering::LocalCalendar& calendar,
                             const Recording& recording, const SiteCalibration& result,
                             const RunFacts& facts, std::string generated_at) {
  report::ReportData data{.title = "Calibration of " + site.name,
                          .generated_at = std::move(generated_at),
                          .site = {site.id, site.name, site.timezone},
                          .calendar = calendar,
                          .provenance = provenance_of(facts)};
  add_answer(recording, result, data);
  if (!result.calibration.converged) {
    data.notices.push_back({report::Severity::failure,
                            "The sampler has not converged to the limits set for it (R-hat, "
                            "effective sample size): treat intervals as rough."});
  }
  for (const std::string& alarm : result.alarms) {
    data.notices.push_back({report::Severity::warning, alarm});
  }
  for (const std::string& warning : result.warnings) {
    data.notices.push_back({report::Severity::warning, warning});
  }
  for (const assessment::OutputCalibration& output : result.outputs) {
    if (is_peak(output)) continue;  // the page shows peaks as measured, beside each other
    data.outputs.push_back({.label = meter_label(recording.meters[output.meter].meter.id),
                            .months = months_of(recording, result, output),
                            .assessment = output.assessment});
  }
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    data.parameters.push_back(parameter_of(result, j));
  }
  for (const MeterRecord& record : recording.meters) {
    for (metering::DataFinding finding : record.findings) {
      finding.meter = meter_label(finding.meter);
      data.findings.push_back(std::move(finding));
    }
    data.peaks.push_back({meter_label(record.meter.id), record.figures});
    data.loads.push_back(load_of(record));
  }
  using enum model::DayType;
  data.profile = {
      .day_types = {day_profile_of(result.profile, workday, "Working day"),
                    day_profile_of(result.profile, saturday, "Saturday"),
                    day_profile_of(result.profile, sunday_or_holiday, "Sunday and holiday")},
      .check_sentence = result.profile.check.words};
  add_not_known(recording, result, data);
  return data;
}

}  // namespace recald::daemon
