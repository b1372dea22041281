#include "daemon/site/results/result_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"

namespace recald::daemon {
namespace {

std::string cells(const std::optional<assessment::FitMetrics>& metrics) {
  if (!metrics) return fmt::format("{:>8}{:>8}{:>9}", "-", "-", "-");
  return fmt::format("{:>+8.3f}{:>+8.3f}{:>9.3f}", metrics->nmbe_sim_minus_meas, metrics->nmbe_g14,
                     metrics->cvrmse);
}

/// "Chilled water, daily mean"
std::string row_label(const assessment::OutputCalibration& output) {
  return display::capitalised(display::output_words(output.name));
}

/// Width of the first column: the longest label and two blanks.
std::size_t label_width(const assessment::AssessedCalibration& result) {
  std::size_t width = 16;
  for (const assessment::OutputCalibration& output : result.outputs) {
    width = std::max(width, display::output_words(output.name).size() + 2);
  }
  return width;
}

/// The seed's Tables 3 and 4: every output before and after, on calibration and validation months.
/// Where nothing was calibrated, forecasts alone.
std::string fit_lines(const assessment::AssessedCalibration& result) {
  const std::size_t width = label_width(result);
  const auto line = [width](const std::string& label, const char* stage,
                            const std::string& calibration, const std::string& validation) {
    return fmt::format("{:<{}}{:<12}|{} |{}\n", label, width, stage, calibration, validation);
  };
  const auto stage_line = [&](const std::string& label, const char* stage,
                              const assessment::PeriodMetrics& metrics) {
    return line(label, stage, cells(metrics.calibration), cells(metrics.validation));
  };
  std::string text = fmt::format("{:<{}}| {:^24} | {:^24}\n", "monthly figures", width + 12,
                                 "calibration months", "validation months");
  const std::string heads = fmt::format("{:>8}{:>8}{:>9}", "sim-meas", "G14", "CV(RMSE)");
  text += line("output", "NMBE:", heads, heads);
  for (const assessment::OutputCalibration& output : result.outputs) {
    const assessment::OutputAssessment& a = output.assessment;
    const auto forecast_line = [&](const std::string& label, const char* stage,
                                   const assessment::ForecastAssessment& forecast) {
      return line(label, stage, cells(forecast.calibration.metrics),
                  cells(forecast.validation.metrics));
    };
    text += forecast_line(row_label(output), "forecast", a.forecast);
    if (result.parameters.empty()) continue;
    if (a.yardstick) text += forecast_line("", "yardstick", *a.yardstick);
    text += stage_line("", "prior mode", a.before);
    text += stage_line("", "prior mean", a.prior_mean);
    text += stage_line("", "after", a.after);
  }
  return text;
}

/// How honest the bands were, on the months that say most.
std::string band_lines(const assessment::AssessedCalibration& result) {
  std::string text;
  for (const assessment::OutputCalibration& output : result.outputs) {
    const assessment::ForecastAssessment& forecast = output.assessment.forecast;
    const bool unseen = forecast.validation.scores.has_value();
    const auto& scores = unseen ? forecast.validation.scores : forecast.blocks.scores;
    if (!scores) continue;
    text +=
        fmt::format("{}: {} of {} {} inside the 90 % bands", row_label(output), scores->inside_90,
                    scores->months, unseen ? "unseen months" : "months, three left out at a time,");
    if (forecast.unseen_mean) {
      const auto& [measured, mean] = *forecast.unseen_mean;
      const display::Unit unit = display::unit_of(result.units, output.unit, output.utility);
      text += fmt::format("; their mean {:.4g} to {:.4g} {}, measured {:.4g}", unit.shown(mean.q05),
                          unit.shown(mean.q95), unit.name, unit.shown(measured));
    }
    text += ".\n";
  }
  return text.empty() ? "" : text + "\n";
}

/// Outputs that are followed and not fitted, parameters that the data leave as they were.
std::string unsettled_lines(const assessment::AssessedCalibration& result) {
  std::string text;
  for (const assessment::OutputCalibration& output : result.outputs) {
    if (output.not_fitted_because.empty()) continue;
    text += fmt::format("{} is not fitted. {}\n", row_label(output), output.not_fitted_because);
  }
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    if (assessment::is_identified(result, j)) continue;
    const calibration::Summary& s = result.calibration.parameters[j];
    text += fmt::format("{} is not identified: contraction {:.2f}, at most {:.2f} was possible.\n",
                        display::capitalised(display::parameter_words(s.name)), s.contraction,
                        assessment::contraction_max(result, j));
  }
  return text;
}

std::string metamodel_lines(const assessment::AssessedCalibration& result) {
  if (!result.metamodel) return "";
  std::string text =
      fmt::format("Meta-model, form {}: {}\n", result.metamodel->form, result.metamodel->why);
  if (result.fixed_parameters.empty()) return text;
  text += "Held at their prior means, their spread counted as error of the model:";
  const char* separator = " ";
  for (const Parameter& parameter : result.fixed_parameters) {
    text += separator + display::parameter_words(parameter.name);
    separator = ", ";
  }
  return text + ".\n";
}

std::string parameter_lines(const assessment::AssessedCalibration& result) {
  struct Row {
    const calibration::Summary& s;
    double prior;
  };
  std::vector<Row> rows;
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    rows.push_back({result.calibration.parameters[j], result.parameters[j].prior.mode()});
  }
  for (const calibration::Summary& s : result.calibration.hyperparameters) {
    rows.push_back({s, s.prior_mean});
  }
  std::size_t width = 0;
  for (const Row& row : rows) {
    width = std::max(width, display::parameter_words(row.s.name).size() + 2);
  }
  std::string text =
      fmt::format("{:<{}}{:<19}{:>10}{:>10}{:>10}{:>10}{:>13}{:>8}{:>10}\n", "parameter", width,
                  "unit", "prior", "mean", "5 %", "95 %", "contraction", "R-hat", "ESS bulk");
  for (const auto& [s, prior] : rows) {
    const display::Unit unit = display::unit_of(result.units, s.unit);
    text += fmt::format(
        "{:<{}}{:<19}{:>10.4g}{:>10.4g}{:>10.4g}{:>10.4g}{:>13.2f}{:>8.3f}{:>10.0f}\n",
        display::parameter_words(s.name), width, unit.name, unit.shown(prior), unit.shown(s.mean),
        unit.shown(s.q05), unit.shown(s.q95), s.contraction, s.rhat, s.ess_bulk);
  }
  return text;
}

std::string forecasts_alone_table(const assessment::AssessedCalibration& result) {
  return result.not_calibrated_because + "\n\n" + fit_lines(result) +
         "forecast: a regression of the meter's days on temperature; a calibration month from the "
         "others.\n\n" +
         band_lines(result) + display::warning_lines(result.warnings);
}

}  // namespace

std::string result_table(const assessment::AssessedCalibration& result) {
  if (!result.not_calibrated_because.empty()) return forecasts_alone_table(result);
  std::string text = display::warning_lines(result.alarms) + fit_lines(result);
  text +=
      "forecast: the model and what the calibration months say of its error; a calibration month "
      "from "
      "the others.\nprior mode, prior mean, after: the model alone, which savings and diagnoses "
      "use.\n\n";
  text += band_lines(result) + parameter_lines(result) + "\n" + unsettled_lines(result);
  for (const assessment::OutputCalibration& output : result.outputs) {
    const auto& after = output.assessment.after.calibration;
    if (!after || !output.calibrated) continue;
    const auto verdict = assessment::guideline14_verdict(*after);
    text += fmt::format("Guideline 14, {}: {}. {}\n", display::output_words(output.name),
                        verdict.pass ? "pass" : "fail", verdict.why);
  }
  return text + metamodel_lines(result) + display::warning_lines(result.warnings);
}

}  // namespace recald::daemon
