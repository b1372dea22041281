#include <algorithm>
#include <string>
#include <vector>

#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/sections.hpp"
#include "core/display/id_words.hpp"

namespace recald::views {
namespace {

using assessment::FitMetrics;
using assessment::PeriodMetrics;

void add_cells(std::vector<Cell>& cells, const std::optional<FitMetrics>& metrics) {
  cells.push_back({metrics ? signed_percent_text(metrics->nmbe_sim_minus_meas) : "–", "number"});
  cells.push_back({metrics ? percent_text(metrics->cvrmse) : "–", "number"});
}

void add_row(Table& table, const std::string& name, const PeriodMetrics& metrics) {
  std::vector<Cell> cells{{name}};
  add_cells(cells, metrics.calibration);
  add_cells(cells, metrics.validation);
  table.row(std::move(cells));
}

/// Each label once, in the order of the models.
std::vector<std::string> labels_of(const std::vector<ComparedModel>& models, auto list) {
  std::vector<std::string> labels;
  for (const ComparedModel& model : models) {
    for (const auto& [label, value] : model.*list) {
      if (std::ranges::find(labels, label) == labels.end()) labels.push_back(label);
    }
  }
  return labels;
}

template <class Value>
const Value* find(const std::vector<std::pair<std::string, Value>>& list,
                  const std::string& label) {
  const auto found = std::ranges::find(
      list, label, [](const auto& one) -> const auto& { return one.first; });
  return found == list.end() ? nullptr : &found->second;
}

void write_fits(Html& html, const std::vector<ComparedModel>& models) {
  Table table("Bias and scatter of each model's monthly figures");
  table.column_groups({{"", 1}, {"Calibration months", 2}, {"Validation months", 2}});
  table.columns({"Model", "NMBE, expected\u00a0−\u00a0meter", "CV(RMSE)",
                 "NMBE, expected\u00a0−\u00a0meter", "CV(RMSE)"});
  for (const std::string& label : labels_of(models, &ComparedModel::outputs)) {
    table.group(label);
    for (const ComparedModel& model : models) {
      const ComparedFit* fit = find(model.outputs, label);
      if (fit == nullptr) continue;
      add_row(table, model.name + ", before", fit->before);
      add_row(table, model.name + ", after", fit->after);
      add_row(table, model.name + ", forecast", fit->forecast);
    }
  }
  table.write(html);
}

void write_parameters(Html& html, const std::vector<ComparedModel>& models) {
  const auto labels = labels_of(models, &ComparedModel::parameters);
  if (labels.empty()) return;
  html.element("h3", "What each model makes of the building");
  Table table("Posterior medians with 90 % intervals");
  std::vector<std::string> columns{"Parameter"};
  for (const ComparedModel& model : models) columns.push_back(model.name);
  table.columns(columns);
  for (const std::string& label : labels) {
    std::vector<Cell> cells{{label}};
    for (const ComparedModel& model : models) {
      const std::string* value = find(model.parameters, label);
      cells.push_back({value == nullptr ? "–" : *value, "number"});
    }
    table.row(std::move(cells));
  }
  table.write(html);
}

}  // namespace

void write_comparison_section(Html& html, const ReportData& data) {
  if (data.compared.empty()) return;
  open_section(html, "models", "Which model tells more?");
  html.element("p",
               "All models are held against the same months. Before is a model at its prior modes, "
               "after the calibrated model alone, and the forecast adds what is known of its "
               "errors.");
  for (const ComparedModel& model : data.compared) {
    if (!model.note.empty()) html.element("p", model.name + ": " + model.note);
  }
  write_fits(html, data.compared);
  write_parameters(html, data.compared);
  html.markup("</section>\n");
}

}  // namespace recald::views
