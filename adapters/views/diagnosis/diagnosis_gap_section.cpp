#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "adapters/views/diagnosis/diagnosis_sections.hpp"
#include "adapters/views/frame/format.hpp"

namespace recald::views {
namespace {

void add_gap_row(Table& table, const std::string& label, const diagnosis::MeterGap& gap) {
  table.row({{label},
             {percent_text(gap.cvrmse_daily), "number"},
             {percent_text(gap.cvrmse_monthly), "number"},
             {signed_percent_text(gap.nmbe_sim_minus_meas), "number"},
             {number_text(gap.log_score), "number"},
             {percent_text(gap.discrepancy_share, 0), "number"}});
}

const std::vector<std::string>& gap_columns() {
  static const std::vector<std::string> kColumns{"",
                                                 "CV(RMSE) of days",
                                                 "CV(RMSE) of months",
                                                 "Bias, model − meter",
                                                 "Log score a month",
                                                 "Structured share of what is left"};
  return kColumns;
}

Table step_table(const DiagnosisData& data) {
  Table table("The gap on the months kept back, step by step");
  table.columns(gap_columns());
  for (std::size_t g = 0; g < data.meters.size(); ++g) {
    table.group(data.meters[g]);
    for (const GapStep& step : data.steps) add_gap_row(table, step.label, step.gaps[g]);
  }
  return table;
}

Table measure_table(const DiagnosisData& data, const GapMeasure& measure) {
  Table table{std::string{measure.label}};
  std::vector<std::string> columns{"Model"};
  columns.insert(columns.end(), data.meters.begin(), data.meters.end());
  table.columns(std::move(columns));
  for (const GapStep& step : data.steps) {
    std::vector<Cell> row{{step.label}};
    for (std::size_t g = 0; g < data.meters.size(); ++g) {
      const double value = measure.value(data.steps.front().gaps[g], step.gaps[g]);
      row.push_back({measure.is_share ? percent_text(value) : number_text(value), "number"});
    }
    table.row(std::move(row));
  }
  return table;
}

void write_measures(Html& html, const DiagnosisData& data) {
  html.markup("<p class=\"key\" id=\"step-key\" aria-hidden=\"true\"></p>\n")
      .markup("<div class=\"multiples\">\n");
  int index = 0;
  for (const GapMeasure& measure : gap_measures()) {
    const std::string label{measure.label};
    write_figure(html,
                 {.kind = "steps",
                  .index = index++,
                  .title = label,
                  .description = label + " of each meter, from the model as drawn through each "
                                         "addition, on the months kept back.",
                  .caption = measure.is_share ? "Lower is better."
                                              : "Above the model as drawn. Higher is better.",
                  .size = "small"},
                 measure_table(data, measure));
  }
  html.markup("</div>\n");
}

void write_judgement(Html& html, const DiagnosisData& data) {
  if (data.not_confirmed) {
    html.element("p",
                 "Not confirmed: on the months kept back the model with the additions is not "
                 "better by three to one, or predicts one meter clearly worse, or the monthly "
                 "model speaks against them. What was tried has been withdrawn.",
                 "bad");
  } else if (data.outcome == diagnosis::Outcome::named) {
    html.element("p",
                 "The months kept back confirm it: they are predicted better, by more than three "
                 "to one over all meters, the effect's evidence counted as on this page, and no "
                 "meter is predicted clearly worse.");
  } else {
    html.element("p",
                 "Nothing was added, so there is nothing to compare: this is how well the "
                 "calibrated model predicts the months kept back.");
  }
}

void write_other_models(Html& html, const DiagnosisData& data) {
  if (data.other_gaps.empty()) return;
  Table table("Other models of the site, given the same effects, on the same months");
  table.columns({"Model and output", "CV(RMSE) before", "after", "Bias, model − meter, before",
                 "after", "Log score a month before", "after"});
  for (const diagnosis::ModelGap& gap : data.other_gaps) {
    for (std::size_t i = 0; i < gap.outputs.size(); ++i) {
      const auto& before = gap.before[i];
      const auto& after = gap.after[i];
      const bool is_energyplus = gap.model == ModelKind::energyplus;
      const std::string_view model = is_energyplus ? "EnergyPlus" : "Monthly model";
      table.row({{fmt::format("{}: {}", model, gap.outputs[i])},
                 {percent_text(before.cvrmse), "number"},
                 {percent_text(after.cvrmse), "number"},
                 {signed_percent_text(before.nmbe_sim_minus_meas), "number"},
                 {signed_percent_text(after.nmbe_sim_minus_meas), "number"},
                 {number_text(before.log_score), "number"},
                 {number_text(after.log_score), "number"}});
    }
  }
  table.write(html);
}

}  // namespace

void write_gap_section(Html& html, const DiagnosisData& data) {
  if (data.steps.empty()) return;
  assert(data.steps.front().gaps.size() == data.meters.size());
  open_section(html, "gap", "Did the gap shrink on months that chose nothing?");
  write_judgement(html, data);
  if (data.steps.size() > 1) write_measures(html, data);
  step_table(data).write(html);
  write_other_models(html, data);
  html.element(
      "p",
      "CV(RMSE) is the scatter of days or months around the meter, as a share of its mean. "
      "The log score rewards a model whose uncertainty is as large as its errors. The "
      "last column is the part of what is left that has a pattern instead of being noise; "
      "it is taken on the fitted months.",
      "muted");
  html.markup("</section>\n");
}

void write_base_section(Html& html, const DiagnosisData& data) {
  if (data.base_fit.empty()) return;
  assert(data.base_fit.size() == data.meters.size());
  open_section(html, "base", "What did the diagnosis start from?");
  html.element("p",
               "The model as drawn, its uncertain parameters calibrated: how it tells the months "
               "that it was fitted to. A scatter of days far above 10 % says that the model misses "
               "more than one effect, and that names are to be taken with care.");
  Table table("The calibrated model on the fitted months");
  table.columns(gap_columns());
  for (std::size_t g = 0; g < data.meters.size(); ++g) {
    add_gap_row(table, data.meters[g], data.base_fit[g]);
  }
  table.write(html);
  html.markup("</section>\n");
}

}  // namespace recald::views
