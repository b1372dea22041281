#include "daemon/site/results/report_of.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/absent.hpp"
#include "daemon/site/results/diagnosis_words.hpp"

namespace recald::daemon {
namespace {

report::Provenance provenance_of(const RunFacts& facts) {
  return {.recald_version = facts.recald_version,
          .data_revision = facts.data_revision,
          .model_version = facts.model_version,
          .time_zone_data = facts.time_zone_data,
          .weather_values = facts.weather_values,
          .sampler = facts.sampler,
          .hyper_prior_profile = facts.hyper_prior_profile,
          .seed = facts.seed,
          .iterations = facts.iterations,
          .burn_in = facts.burn_in,
          // No computing time: the same data and seed give the same page.
          .chains = facts.chains};
}

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
         .box = output.assessment.boxes[i]});
  }
  for (const metering::MonthlyFigure& figure : record.figures) {
    if (std::ranges::find(result.months, figure.month) != result.months.end()) continue;
    months.push_back({.figure = figure, .box = {}});
  }
  for (report::OutputMonth& month : months) {
    month.flagged_different = is_site_different(recording, month.figure.month);
  }
  std::ranges::sort(months, {},
                    [](const report::OutputMonth& month) { return month.figure.month; });
  return months;
}

report::HourStatus status_of(const profile::HourlyLoad& hour) {
  if (hour.suspect) return report::HourStatus::suspect;
  if (hour.ok_share <= 0.0) return report::HourStatus::missing;
  return hour.ok_share < 1.0 ? report::HourStatus::partly_filled : report::HourStatus::ok;
}

report::LoadGrid load_of(const MeterRecord& record) {
  report::LoadGrid grid{.meter = meter_label(record.meter.id)};
  if (record.hours.empty()) return grid;
  grid.first_day = record.hours.begin()->first / 1;
  const metering::Month last = record.hours.rbegin()->first;
  const std::chrono::sys_days begin{grid.first_day};
  const std::chrono::sys_days end{metering::next_month(last) / 1};
  const auto cells = static_cast<std::size_t>((end - begin).count()) * 24;
  grid.mean_kW.assign(cells, std::numeric_limits<float>::quiet_NaN());
  grid.status.assign(cells, report::HourStatus::missing);
  for (const auto& [month, hours] : record.hours) {
    for (const profile::HourlyLoad& hour : hours) {
      const auto day = (std::chrono::sys_days{hour.date} - begin).count();
      const auto cell = static_cast<std::size_t>(day * 24 + hour.hour);
      grid.mean_kW[cell] = static_cast<float>(hour.mean_kW);
      grid.status[cell] = status_of(hour);
    }
  }
  return grid;
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

void add_headlines(const Recording& recording, const SiteCalibration& result,
                   report::ReportData& data) {
  int passing = 0;
  int judged = 0;
  for (const assessment::OutputCalibration& output : result.outputs) {
    const auto& after = output.assessment.after.calibration;
    // Electricity that its own profile reproduces is no evidence for the model.
    if (!after || !output.calibrated || is_peak(output)) continue;
    const auto verdict = assessment::guideline14_verdict(*after);
    data.verdicts.push_back({meter_label(recording.meters[output.meter].meter.id), verdict});
    judged += 1;
    passing += verdict.pass ? 1 : 0;
  }
  const bool converged = result.calibration.converged;
  data.headlines.push_back(
      judged == 0
          ? "No output had enough measured months to judge the model."
          : fmt::format("{} of {} fitted meters are met within the monthly limits of ASHRAE "
                        "Guideline 14 after calibration{}.",
                        passing, judged, converged ? "" : ", but the sampler has not converged"));
  for (const assessment::OutputCalibration& output : result.outputs) {
    const auto& a = output.assessment;
    if (is_peak(output) || !a.before.calibration || !a.prior_mean.calibration ||
        !a.after.calibration) {
      continue;
    }
    std::string line = fmt::format(
        "{}: CV(RMSE) {} before calibration, {} at the prior mean, {} after",
        meter_label(recording.meters[output.meter].meter.id), percent(a.before.calibration->cvrmse),
        percent(a.prior_mean.calibration->cvrmse), percent(a.after.calibration->cvrmse));
    if (a.after.validation) {
      line += fmt::format("; on months it has not seen {}", percent(a.after.validation->cvrmse));
    }
    data.headlines.push_back(line + ".");
  }
}

void add_not_known(const SiteCalibration& result, report::ReportData& data) {
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    const calibration::Summary& s = result.calibration.parameters[j];
    if (s.contraction > 0.25) continue;
    data.not_known.push_back(fmt::format(
        "{}: the measurements narrow it by {:.0f} % of its variance at most; its value is what "
        "was assumed.",
        result.definitions[j]->label, 100.0 * std::max(s.contraction, 0.0)));
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
  add_headlines(recording, result, data);
  if (!result.calibration.converged) {
    data.notices.push_back({report::Severity::failure,
                            "The sampler has not converged to the limits set for it (R-hat, "
                            "effective sample size): treat intervals as rough."});
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
  add_not_known(result, data);
  return data;
}

}  // namespace recald::daemon
