#include "daemon/results/result_table.hpp"

#include <fmt/format.h>

namespace recald::daemon {
namespace {

std::string cells(const std::optional<assessment::FitMetrics>& metrics) {
  if (!metrics) return fmt::format("{:>8}{:>8}{:>9}", "-", "-", "-");
  return fmt::format("{:>+8.3f}{:>+8.3f}{:>9.3f}", metrics->nmbe_sim_minus_meas, metrics->nmbe_g14,
                     metrics->cvrmse);
}

std::string stage_line(const std::string& meter, const char* stage,
                       const assessment::PeriodMetrics& metrics) {
  return fmt::format("{:<16}{:<12}|{} |{}\n", meter, stage, cells(metrics.calibration),
                     cells(metrics.validation));
}

std::string parameter_lines(const SiteCalibration& result) {
  std::string text =
      fmt::format("{:<20}{:<12}{:>10}{:>10}{:>10}{:>10}{:>13}{:>8}{:>10}\n", "parameter", "unit",
                  "prior", "mean", "5 %", "95 %", "contraction", "R-hat", "ESS bulk");
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    const calibration::Summary& s = result.calibration.parameters[j];
    text +=
        fmt::format("{:<20}{:<12}{:>10.4g}{:>10.4g}{:>10.4g}{:>10.4g}{:>13.2f}{:>8.3f}{:>10.0f}\n",
                    s.name, s.unit, result.parameters[j].prior.mode, s.mean, s.q05, s.q95,
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

std::string result_table(const SiteCalibration& result, const Recording& recording) {
  std::string text = fmt::format("{:<28}| {:^24} | {:^24}\n", "monthly daily averages",
                                 "calibration months", "validation months");
  const std::string heads = fmt::format("{:>8}{:>8}{:>9}", "sim-meas", "G14", "CV(RMSE)");
  text += fmt::format("{:<16}{:<12}|{} |{}\n", "meter", "NMBE:", heads, heads);
  for (const OutputCalibration& output : result.outputs) {
    const std::string& id = recording.meters[output.meter].meter.id;
    text += stage_line(id, "prior mode", output.assessment.before);
    text += stage_line("", "prior mean", output.assessment.prior_mean);
    text += stage_line("", "after", output.assessment.after);
  }
  text += "\n" + parameter_lines(result) + "\n";
  for (const OutputCalibration& output : result.outputs) {
    const auto& after = output.assessment.after.calibration;
    if (!after || !output.calibrated) continue;
    const auto verdict = assessment::guideline14_verdict(*after);
    text += fmt::format("Guideline 14, {}: {}. {}\n", recording.meters[output.meter].meter.id,
                        verdict.pass ? "pass" : "fail", verdict.why);
  }
  for (const std::string& warning : result.warnings) text += "! " + warning + "\n";
  return text;
}

}  // namespace recald::daemon
