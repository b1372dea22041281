#include "daemon/site/results/comparison.hpp"

#include <fmt/format.h>

#include <string_view>

#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "core/text/number_text.hpp"

namespace recald::daemon {
namespace {

using assessment::FitMetrics;
using assessment::PeriodMetrics;
using Json = nlohmann::ordered_json;

views::ComparedFit fit_of(const assessment::OutputAssessment& assessed) {
  return {assessed.before,
          assessed.after,
          {assessed.forecast.calibration.metrics, assessed.forecast.validation.metrics}};
}

std::string compared_label(const assessment::OutputCalibration& output) {
  return display::meter_label(output.meter_id) + (output.unit == "kW" ? " peak" : "");
}

Json fit_json(const std::optional<FitMetrics>& metrics) {
  if (!metrics) return nullptr;
  return {{"nmbe_sim_minus_meas", metrics->nmbe_sim_minus_meas}, {"cvrmse", metrics->cvrmse}};
}

Json period_json(const PeriodMetrics& metrics) {
  return {{"calibration", fit_json(metrics.calibration)},
          {"validation", fit_json(metrics.validation)}};
}

std::string cv_words(const PeriodMetrics& metrics) {
  const auto& shown = metrics.validation ? metrics.validation : metrics.calibration;
  return shown ? percent_text(shown->cvrmse) : "–";
}

}  // namespace

std::string model_label(ModelKind kind) {
  switch (kind) {
    case ModelKind::epc:
      return "EPC";
    case ModelKind::hourly:
      return "Hourly model";
    case ModelKind::metamodel:
      return "Meta-model";
    case ModelKind::energyplus:
      break;
  }
  return "EnergyPlus";
}

std::vector<views::ComparedModel> compared_models(const std::vector<SiteModelResult>& models) {
  std::vector<views::ComparedModel> compared;
  for (const SiteModelResult& model : models) {
    views::ComparedModel& shown = compared.emplace_back();
    shown.name = model_label(model.kind);
    if (!model.done) {
      shown.note = model.done.error().message + ".";
      continue;
    }
    const SiteCalibration& result = model.done->calibration;
    shown.note = result.not_calibrated_because;
    for (const assessment::OutputCalibration& output : result.outputs) {
      shown.outputs.emplace_back(compared_label(output), fit_of(output.assessment));
    }
    for (std::size_t j = 0; j < result.calibration.parameters.size(); ++j) {
      const calibration::Summary& found = result.calibration.parameters[j];
      const display::Unit unit = display::unit_of(result.units, found.unit);
      shown.parameters.emplace_back(
          result.parameters[j].label,
          fmt::format("{:.3g} ({:.3g} to {:.3g}){}{}", unit.shown(found.q50), unit.shown(found.q05),
                      unit.shown(found.q95), unit.name.empty() ? "" : " ", unit.name));
    }
  }
  return compared;
}

Json comparison_json(const std::vector<SiteModelResult>& models) {
  Json all = Json::array();
  for (const SiteModelResult& model : models) {
    Json one = {{"model", name_of(model.kind)}};
    if (!model.done) {
      one["failed"] = model.done.error().message;
      all.push_back(std::move(one));
      continue;
    }
    const SiteCalibration& result = model.done->calibration;
    one["status"] = result.calibration.converged ? "converged" : "not converged";
    for (const assessment::OutputCalibration& output : result.outputs) {
      const views::ComparedFit fit = fit_of(output.assessment);
      one["outputs"][output.name] = {{"fitted", output.calibrated},
                                     {"before", period_json(fit.before)},
                                     {"after", period_json(fit.after)},
                                     {"forecast", period_json(fit.forecast)}};
    }
    for (std::size_t j = 0; j < result.calibration.parameters.size(); ++j) {
      const calibration::Summary& found = result.calibration.parameters[j];
      one["parameters"].push_back({{"name", result.parameters[j].name},
                                   {"unit", found.unit},
                                   {"q05", found.q05},
                                   {"q50", found.q50},
                                   {"q95", found.q95}});
    }
    all.push_back(std::move(one));
  }
  return {{"models", std::move(all)}};
}

std::string comparison_words(const std::vector<SiteModelResult>& models) {
  std::string text =
      "\nModels beside each other, CV(RMSE) of the model before and after, and of the "
      "forecast:\n";
  for (const views::ComparedModel& model : compared_models(models)) {
    if (!model.note.empty()) text += fmt::format("  {:<14} {}\n", model.name, model.note);
    for (const auto& [label, fit] : model.outputs) {
      text += fmt::format("  {:<14} {:<24} {:>8} {:>8} {:>8}\n", model.name, label,
                          cv_words(fit.before), cv_words(fit.after), cv_words(fit.forecast));
    }
  }
  return text;
}

}  // namespace recald::daemon
