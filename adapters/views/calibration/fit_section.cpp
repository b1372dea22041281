#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/histogram.hpp"
#include "adapters/views/frame/sections.hpp"
#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::views {
namespace {

using assessment::FitMetrics;
using assessment::ForecastFit;
using assessment::kMonthlyLimits;
using assessment::MonthRole;

Cell judged_cell(const std::string& text, double magnitude, double limit) {
  if (!std::isfinite(magnitude)) return {"–", "number"};
  const bool within = magnitude <= limit;
  return {fmt::format("{}\u00a0{}", text, within ? "✓" : "✕"),
          within ? "number good" : "number bad"};
}

void add_metric_cells(std::vector<Cell>& cells, const std::optional<FitMetrics>& metrics) {
  if (!metrics) {
    cells.insert(cells.end(), 3, Cell{"–", "number"});
    return;
  }
  cells.push_back(judged_cell(signed_percent_text(metrics->nmbe_sim_minus_meas),
                              std::abs(metrics->nmbe_sim_minus_meas), kMonthlyLimits.nmbe));
  cells.push_back({signed_percent_text(metrics->nmbe_g14), "number muted"});
  cells.push_back(
      judged_cell(percent_text(metrics->cvrmse), metrics->cvrmse, kMonthlyLimits.cvrmse));
}

void add_stage(Table& table, const char* stage, const std::optional<FitMetrics>& calibration,
               const std::optional<FitMetrics>& validation) {
  std::vector<Cell> cells{{stage}};
  add_metric_cells(cells, calibration);
  add_metric_cells(cells, validation);
  table.row(std::move(cells));
}

/// Combines tables 3 and 4 of the seed: the forecasts first, with the prior mean as a
/// second "before".
void write_metrics(Html& html, const std::vector<OutputResult>& outputs) {
  Table table(
      "Bias and scatter of the monthly figures. ✓ within and ✕ outside the limits of "
      "Guideline 14");
  table.column_groups({{"", 1}, {"Calibration months", 3}, {"Validation months", 3}});
  const std::string model_high = "NMBE, expected\u00a0−\u00a0meter";
  const std::string meter_high = "NMBE, meter\u00a0−\u00a0expected";
  table.columns(
      {"Expected by", model_high, meter_high, "CV(RMSE)", model_high, meter_high, "CV(RMSE)"});
  for (const OutputResult& output : outputs) {
    if (!output.assessment) continue;
    const assessment::OutputAssessment& fit = *output.assessment;
    table.group(output.label);
    add_stage(table, "Forecast", fit.forecast.calibration.metrics, fit.forecast.validation.metrics);
    if (fit.yardstick) {
      add_stage(table, "Regression of days", fit.yardstick->calibration.metrics,
                fit.yardstick->validation.metrics);
    }
    add_stage(table, "Model, before (prior mode)", fit.before.calibration, fit.before.validation);
    add_stage(table, "Model, prior mean", fit.prior_mean.calibration, fit.prior_mean.validation);
    add_stage(table, "Model, after", fit.after.calibration, fit.after.validation);
  }
  html.element("h3", "Forecast and model against the meters");
  const bool has_yardstick = std::ranges::any_of(outputs, [](const OutputResult& output) {
    return output.assessment && output.assessment->yardstick;
  });
  const std::string regression =
      has_yardstick ? "The regression takes the meter's days and the outdoor temperature alone. "
                    : "";
  html.element(
      "p",
      "NMBE is the mean bias and CV(RMSE) the scatter, both as a share of the mean measured "
      "consumption. Expected − meter is positive where too much is expected; Guideline 14 itself "
      "writes meter − expected, so both are given. The forecast is the model with what the "
      "calibration months say of its error; a calibration month is forecast from the others. " +
          regression + "The model alone is what savings and diagnoses are computed with.");
  table.write(html);
}

void add_score_cells(std::vector<Cell>& cells, const ForecastFit& fit, const display::Unit& unit) {
  if (!fit.scores) {
    cells.insert(cells.end(), 4, Cell{"–", "number"});
    return;
  }
  const double months = fit.scores->months;
  cells.push_back({percent_text(fit.scores->inside_50 / months, 0), "number"});
  cells.push_back({percent_text(fit.scores->inside_90 / months, 0), "number"});
  cells.push_back({number_text(unit.shown(fit.scores->crps)), "number"});
  cells.push_back({number_text(unit.shown(fit.scores->interval_score_90)), "number"});
}

void write_scores(Html& html, const std::vector<OutputResult>& outputs) {
  const bool any = std::any_of(outputs.begin(), outputs.end(), [](const OutputResult& output) {
    const auto& fit = output.assessment;
    return fit && (fit->forecast.calibration.scores || fit->forecast.validation.scores);
  });
  if (!any) return;
  Table table("Measured months inside the forecasts' intervals, and their scores");
  table.column_groups({{"", 1}, {"Calibration months", 4}, {"Validation months", 4}});
  table.columns({"Output", "Inside 50 %", "Inside 90 %", "CRPS", "Score of 90 %", "Inside 50 %",
                 "Inside 90 %", "CRPS", "Score of 90 %"});
  for (const OutputResult& output : outputs) {
    if (!output.assessment) continue;
    const auto row = [&](const std::string& name, const assessment::ForecastAssessment& forecast) {
      std::vector<Cell> cells{{name}};
      add_score_cells(cells, forecast.calibration, output.unit());
      add_score_cells(cells, forecast.validation, output.unit());
      table.row(std::move(cells));
    };
    row(with_unit(output.label, output.unit().name), output.assessment->forecast);
    if (output.assessment->yardstick) row("  Regression of days", *output.assessment->yardstick);
  }
  html.element("h3", "Is the stated uncertainty honest?");
  html.element(
      "p",
      "If it is, about half of the measured months fall inside the 50 % interval and nine "
      "of ten inside the 90 % interval. CRPS and the interval score reward what is both narrow and "
      "right: smaller is better.");
  table.write(html);
}

/// What a month of this output is.
std::string_view figure_words(const OutputResult& output) {
  if (output.is_peak) return "peak demand";
  return output.unit().name.empty() ? "figure" : "daily mean";
}

Table month_table(const OutputResult& output) {
  const display::Unit& unit = output.unit();
  Table table(with_unit(fmt::format("{}: {} of each month", output.label, figure_words(output)),
                        unit.name));
  table.columns({"Month", "Role", "Measured", "Remark", "Estimated", "Forecast: mean", "5 %",
                 "95 %", "Model: 25 %", "Median", "75 %"});
  for (const OutputMonth& month : output.months) {
    std::vector<Cell> cells{
        {month_text(month.figure.month, month.number)},
        {month.role == MonthRole::unused ? "not used" : std::string{name_of(month.role)}},
        {number_text(unit.shown(measured_of(output, month))), "number"}};
    std::string remark = month.figure.usable ? "" : "✕ not usable";
    if (month.flagged_different) remark += remark.empty() ? "◆ different" : ", ◆ different";
    cells.push_back({remark, "nowrap"});
    cells.push_back({percent_text(month.figure.filled_share), "number"});
    const auto box = month.box.value_or(assessment::BoxPlot{NAN, NAN, NAN, NAN, NAN, NAN});
    const auto forecast =
        month.forecast.value_or(assessment::MonthForecast{NAN, NAN, NAN, NAN, NAN, NAN});
    for (const double value :
         {forecast.mean, forecast.q05, forecast.q95, box.q25, box.q50, box.q75}) {
      cells.push_back({number_text(unit.shown(value)), "number"});
    }
    table.row(std::move(cells));
  }
  return table;
}

bool modelled(const OutputResult& output) {
  return std::any_of(output.months.begin(), output.months.end(),
                     [](const OutputMonth& month) { return month.box.has_value(); });
}

std::string months_caption(const OutputResult& output) {
  const bool any_measured = std::any_of(
      output.months.begin(), output.months.end(),
      [&](const OutputMonth& month) { return std::isfinite(measured_of(output, month)); });
  std::string caption = any_measured ? "" : "Nothing was measured in these months. ";
  caption += modelled(output)
                 ? "Box: the middle half of what was expected; whiskers: nine tenths of it. A "
                   "calibration month is forecast from the others. Dash: the model alone. "
                 : "There is no calibrated model yet: measurements only. ";
  if (!has_known_coverage(output)) return caption;
  return caption +
         "The number under a month is the share of its intervals that are estimated, not measured.";
}

void write_months_figure(Html& html, const OutputResult& output, int index) {
  write_figure(
      html,
      {.kind = "months",
       .index = index,
       .title = fmt::format("{}, {} of each month", output.label, figure_words(output)),
       .description = fmt::format("{} of each month of {}, {} months: measured values{}.",
                                  display::capitalised(std::string{figure_words(output)}),
                                  output.label, output.months.size(),
                                  modelled(output) ? " against box plots of the forecasts" : ""),
       .caption = months_caption(output)},
      month_table(output));
}

double share_within_limit(const std::vector<double>& draws) {
  const auto within = std::count_if(draws.begin(), draws.end(),
                                    [](double cvrmse) { return cvrmse <= kMonthlyLimits.cvrmse; });
  return static_cast<double>(within) / static_cast<double>(draws.size());
}

/// "Calibration months: median 10.8 %, 98 % of the draws within 15 %. "
std::string scatter_sentence(std::string_view period, const std::vector<double>& draws) {
  if (draws.empty()) return "";
  return fmt::format("{}: median {}, {} of the draws within 15\u00a0%. ", period,
                     percent_text(median(draws)), percent_text(share_within_limit(draws), 0));
}

void add_bins(Table& table, const std::string& period, const std::vector<double>& draws) {
  const Histogram histogram = make_histogram(draws, kMetricBins);
  if (histogram.counts.empty()) return;
  table.group(period);
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    table.row({{percent_text(histogram.edge(i), 2)},
               {percent_text(histogram.edge(i + 1), 2), "number"},
               {std::to_string(histogram.counts[i]), "number"}});
  }
}

void write_cvrmse_figure(Html& html, const OutputResult& output, int index) {
  if (!output.assessment) return;
  const auto& calibration = output.assessment->draw_cvrmse_calibration;
  const auto& validation = output.assessment->draw_cvrmse_validation;
  if (calibration.empty() && validation.empty()) return;
  Table table(output.label + ": CV(RMSE) of the posterior draws");
  table.columns({"CV(RMSE) from", "To", "Draws"});
  add_bins(table, "Calibration months", calibration);
  add_bins(table, "Validation months", validation);
  const std::string words = scatter_sentence("Calibration months", calibration) +
                            scatter_sentence("Validation months", validation);
  write_figure(html,
               {.kind = "cvrmse",
                .index = index,
                .title = output.label + ", scatter of the draws",
                .description = "Histogram of CV(RMSE) over the posterior draws of " + output.label +
                               ", with the 15 % limit.",
                .caption = words + "Bars left of the dashed line are within the limit.",
                .size = "small"},
               table);
}

/// The signs of the measured months; follows the model's own sign if there is a model.
constexpr std::string_view kMonthsKey =
    "<span><i class=\"sign\">★</i>measured</span>"
    "<span><i class=\"sign hollow\">☆</i>measured, not usable</span>"
    "<span><i class=\"sign different\">◆</i>measured, flagged as different</span></p>\n";

}  // namespace

bool has_model(const ReportData& data) {
  return std::any_of(data.outputs.begin(), data.outputs.end(), modelled);
}

void write_fit_section(Html& html, const ReportData& data) {
  if (data.outputs.empty()) return;
  open_section(html, "fit",
               has_model(data) ? "Does the model follow the meters?" : "How much was used?");
  const bool judged =
      std::any_of(data.outputs.begin(), data.outputs.end(),
                  [](const OutputResult& output) { return output.assessment.has_value(); });
  if (judged) write_metrics(html, data.outputs);
  html.element("h3", "Month by month").markup("<p class=\"key\" aria-hidden=\"true\">");
  if (has_model(data)) {
    html.markup("<span><i class=\"sign box\"></i>forecast</span>");
  }
  html.markup(kMonthsKey);
  for (std::size_t i = 0; i < data.outputs.size(); ++i) {
    write_months_figure(html, data.outputs[i], static_cast<int>(i));
  }
  html.markup("<div class=\"multiples\">\n");
  for (std::size_t i = 0; i < data.outputs.size(); ++i) {
    write_cvrmse_figure(html, data.outputs[i], static_cast<int>(i));
  }
  html.markup("</div>\n");
  write_scores(html, data.outputs);
  html.markup("</section>\n");
}

}  // namespace recald::views
