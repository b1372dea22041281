#include "daemon/site/results/result_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace recald::daemon {
namespace {

std::string cells(const std::optional<assessment::FitMetrics>& metrics) {
  if (!metrics) return fmt::format("{:>8}{:>8}{:>9}", "-", "-", "-");
  return fmt::format("{:>+8.3f}{:>+8.3f}{:>9.3f}", metrics->nmbe_sim_minus_meas, metrics->nmbe_g14,
                     metrics->cvrmse);
}

/// Width of the first column: the longest label and two blanks.
std::size_t label_width(const assessment::AssessedCalibration& result) {
  std::size_t width = 16;
  for (const assessment::OutputCalibration& output : result.outputs) {
    width = std::max(width, output.label.size() + 2);
  }
  return width;
}

/// The seed's Tables 3 and 4: every output before and after, on calibration and validation months.
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
    text += stage_line(output.label, "prior mode", output.assessment.before);
    text += stage_line("", "prior mean", output.assessment.prior_mean);
    text += stage_line("", "after", output.assessment.after);
  }
  return text;
}

std::string metamodel_lines(const assessment::AssessedCalibration& result) {
  if (!result.metamodel) return "";
  std::string text =
      fmt::format("Meta-model, form {}: {}\n", result.metamodel->form, result.metamodel->why);
  if (result.fixed_parameters.empty()) return text;
  text += "Held at their prior means, their spread counted as error of the model:";
  for (const Parameter& parameter : result.fixed_parameters) text += " " + parameter.name;
  return text + "\n";
}

std::string parameter_lines(const assessment::AssessedCalibration& result) {
  std::string text =
      fmt::format("{:<20}{:<12}{:>10}{:>10}{:>10}{:>10}{:>13}{:>8}{:>10}\n", "parameter", "unit",
                  "prior", "mean", "5 %", "95 %", "contraction", "R-hat", "ESS bulk");
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    const calibration::Summary& s = result.calibration.parameters[j];
    text +=
        fmt::format("{:<20}{:<12}{:>10.4g}{:>10.4g}{:>10.4g}{:>10.4g}{:>13.2f}{:>8.3f}{:>10.0f}\n",
                    s.name, s.unit, result.parameters[j].prior.mode(), s.mean, s.q05, s.q95,
                    s.contraction, s.rhat, s.ess_bulk);
  }
  for (const calibration::Summary& s : result.calibration.hyperparameters) {
    text += fmt::format(
        "{:<20}{:<12}{:>10.4g}{:>10.4g}{:>10.4g}{:>10.4g}{:>13.2f}{:>8.3f}{:>10.0f}\n", s.name, "",
        s.prior_mean, s.mean, s.q05, s.q95, s.contraction, s.rhat, s.ess_bulk);
  }
  return text;
}

}  // namespace

std::string result_table(const assessment::AssessedCalibration& result) {
  std::string text = fit_lines(result);
  text += "\n" + parameter_lines(result) + "\n";
  for (const assessment::OutputCalibration& output : result.outputs) {
    const auto& after = output.assessment.after.calibration;
    if (!after || !output.calibrated) continue;
    const auto verdict = assessment::guideline14_verdict(*after);
    text += fmt::format("Guideline 14, {}: {}. {}\n", output.label, verdict.pass ? "pass" : "fail",
                        verdict.why);
  }
  text += metamodel_lines(result);
  for (const std::string& warning : result.warnings) text += "! " + warning + "\n";
  return text;
}

}  // namespace recald::daemon
