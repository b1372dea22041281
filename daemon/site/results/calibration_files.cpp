#include "daemon/site/results/calibration_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "adapters/results/job_result_json.hpp"
#include "adapters/shapes/assessment_shapes.hpp"
#include "adapters/shapes/shape_json.hpp"
#include "adapters/views/frame/provenance.hpp"
#include "core/absent.hpp"
#include "core/display/warning.hpp"
#include "core/regression/fit_quality.hpp"

SHAPE(recald::calibration::Summary, name, unit, mean, sd, q05, q50, q95, contraction, rhat,
      ess_bulk, ess_tail, mcse);
SHAPE(recald::calibration::BridgeEstimate, log_evidence, mcse);

namespace recald::daemon {
namespace {

// Keys in the order they are written: files are read by people too.
using Json = nlohmann::ordered_json;

constexpr assessment::MonthForecast kNoForecast{kAbsent, kAbsent, kAbsent,
                                                kAbsent, kAbsent, kAbsent};

constexpr const char* kMonthsHeader =
    "month,meter,value,unit,coverage,filled_share,peak_kW,peak_at,method,usable,different,"
    "revision,tzdata,estimated_share,value_sd\n";

/// Ends that a prior does not have are null.
Json prior_json(const Prior& prior) {
  return {{"distribution", prior.name()},
          {"min", results::number(prior.min())},
          {"mode", results::number(prior.mode())},
          {"max", results::number(prior.max())},
          {"mean", results::number(prior.mean())},
          {"sd", results::number(std::sqrt(prior.variance()))}};
}

Json parameters_json(const assessment::AssessedCalibration& result) {
  Json list = Json::array();
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    Json entry = shapes::json_of(result.calibration.parameters[j]);
    entry["contraction_max"] = results::number(assessment::contraction_max(result, j));
    entry["identified"] = assessment::is_identified(result, j);
    entry["prior"] = prior_json(result.parameters[j].prior);
    const std::string& source = result.parameters[j].source;
    if (!source.empty()) entry["prior"]["source"] = source;
    list.push_back(std::move(entry));
  }
  return list;
}

/// Parameters that the model has and the calibration leaves at their prior means.
Json fixed_parameters_json(const assessment::AssessedCalibration& result) {
  Json list = Json::array();
  for (const Parameter& parameter : result.fixed_parameters) {
    list.push_back({{"name", parameter.name},
                    {"unit", parameter.unit},
                    {"value", results::number(parameter.prior.mean())},
                    {"prior", prior_json(parameter.prior)}});
  }
  return list;
}

/// What matters most comes first.
Json warnings_json(const assessment::AssessedCalibration& result) {
  Json list = display::texts_of(result.alarms);
  for (std::string& warning : display::texts_of(result.warnings)) {
    list.push_back(std::move(warning));
  }
  return list;
}

Json metamodel_json(const assessment::AssessedCalibration& result) {
  if (!result.metamodel) return nullptr;
  const assessment::MetamodelFacts& facts = *result.metamodel;
  Json sigma_r = Json::object();
  for (std::size_t k = 0; k < facts.sigma_r.size(); ++k) {
    sigma_r[result.outputs[k].name] = results::number(facts.sigma_r[k]);
  }
  return {{"form", facts.form},
          {"why", facts.why},
          {"r2_left_out", results::number(facts.r2_left_out)},
          {"sigma_r", sigma_r}};
}

Json metrics_json(const std::optional<assessment::FitMetrics>& metrics) {
  if (!metrics) return nullptr;
  return {{"nmbe_sim_minus_meas", results::number(metrics->nmbe_sim_minus_meas)},
          {"nmbe_g14", results::number(metrics->nmbe_g14)},
          {"cvrmse", results::number(metrics->cvrmse)},
          {"months", metrics->n}};
}

Json stage_json(const assessment::AssessedCalibration& result,
                assessment::PeriodMetrics assessment::OutputAssessment::*stage) {
  Json calibration = Json::object();
  Json validation = Json::object();
  for (const assessment::OutputCalibration& output : result.outputs) {
    const assessment::PeriodMetrics& metrics = output.assessment.*stage;
    calibration[output.name] = metrics_json(metrics.calibration);
    validation[output.name] = metrics_json(metrics.validation);
  }
  return {{"calibration", calibration}, {"validation", validation}};
}

Json guideline_json(const assessment::AssessedCalibration& result) {
  Json outputs = Json::object();
  bool pass = true;
  std::string why;
  for (const assessment::OutputCalibration& output : result.outputs) {
    const auto& metrics = output.assessment.after.calibration;
    // What was not fitted is judged by no limit for fitted models.
    if (!metrics || !output.calibrated) continue;
    const auto verdict = assessment::guideline14_verdict(*metrics);
    outputs[output.name] = {{"pass", verdict.pass}, {"why", verdict.why}};
    pass = pass && verdict.pass;
    if (!verdict.pass) why += (why.empty() ? "" : " ") + output.name + ": " + verdict.why;
  }
  if (why.empty())
    why = "every fitted output is within the monthly limits over the calibration months";
  return {{"pass", pass}, {"why", why}, {"outputs", outputs}};
}

Json range_json(const assessment::AssessedCalibration& result,
                const std::vector<calibration::OutOfRange>& points) {
  Json list = Json::array();
  for (const calibration::OutOfRange& point : points) {
    list.push_back({{"output", result.outputs[static_cast<std::size_t>(point.output)].name},
                    {"month", result.month_names[static_cast<std::size_t>(point.month)]},
                    {"value", results::number(point.value)},
                    {"range", {results::number(point.low), results::number(point.high)}}});
  }
  return list;
}

/// "measured_kWh", "measured_kW": a number is not written without its unit.
std::string with_unit(const char* name, const assessment::OutputCalibration& output) {
  const std::string unit = output.unit.substr(0, output.unit.find('/'));  // a day's kWh
  return unit.empty() ? name : fmt::format("{}_{}", name, unit);
}

/// CV(RMSE) and NMBE of the expected months, and how many of them the bands held.
Json forecast_fit_json(const assessment::ForecastFit& fit,
                       const assessment::OutputCalibration& output) {
  if (!fit.scores) return nullptr;
  Json json = metrics_json(fit.metrics);
  if (json.is_null()) json = Json::object();
  json["months"] = fit.scores->months;
  json["inside_50"] = fit.scores->inside_50;
  json["inside_90"] = fit.scores->inside_90;
  json[with_unit("crps", output)] = results::number(fit.scores->crps);
  json[with_unit("interval_score_90", output)] = results::number(fit.scores->interval_score_90);
  return json;
}

Json unseen_mean_json(const assessment::ForecastAssessment& forecast) {
  if (!forecast.unseen_mean) return nullptr;
  const auto& [measured, month] = *forecast.unseen_mean;
  Json json = {{"measured", results::number(measured)}};
  json.update(shapes::json_of(month));
  return json;
}

/// @param of  The output's forecast or yardstick; null: it has none.
Json fits_json(const assessment::AssessedCalibration& result,
               const std::function<const assessment::ForecastAssessment*(
                   const assessment::OutputCalibration&)>& of) {
  Json calibration = Json::object();
  Json blocks = Json::object();
  Json validation = Json::object();
  Json unseen_mean = Json::object();
  for (const assessment::OutputCalibration& output : result.outputs) {
    const assessment::ForecastAssessment* forecast = of(output);
    if (forecast == nullptr) continue;
    calibration[output.name] = forecast_fit_json(forecast->calibration, output);
    blocks[output.name] = forecast_fit_json(forecast->blocks, output);
    validation[output.name] = forecast_fit_json(forecast->validation, output);
    unseen_mean[output.name] = unseen_mean_json(*forecast);
  }
  return {{"calibration", calibration},
          {"three_months_left_out", blocks},
          {"validation", validation},
          {"unseen_mean", unseen_mean}};
}

/// One entry an output and month.
Json predictions_json(const assessment::AssessedCalibration& result) {
  Json list = Json::array();
  for (const assessment::OutputCalibration& output : result.outputs) {
    for (std::size_t i = 0; i < result.month_names.size(); ++i) {
      const auto& month = output.assessment.forecast.months[i];
      Json entry = {{"output", output.name},
                    {"month", result.month_names[i]},
                    {"role", name_of(result.roles[i])},
                    {"measured", results::number(output.measured[i])},
                    {"simulated", results::number(output.assessment.simulated[i])}};
      entry.update(shapes::json_of(month.value_or(kNoForecast)));
      list.push_back(std::move(entry));
    }
  }
  return list;
}

/// The limits of Guideline 14 held against months that the forecast has not seen.
Json unseen_limits_json(const assessment::AssessedCalibration& result) {
  Json outputs = Json::object();
  bool pass = true;
  const bool has_validation = std::ranges::any_of(result.outputs, [](const auto& output) {
    return output.assessment.forecast.validation.metrics.has_value();
  });
  for (const assessment::OutputCalibration& output : result.outputs) {
    const assessment::ForecastAssessment& forecast = output.assessment.forecast;
    const auto& metrics = has_validation ? forecast.validation.metrics : forecast.blocks.metrics;
    if (!metrics) continue;
    const auto verdict = assessment::guideline14_verdict(*metrics);
    outputs[output.name] = {{"pass", verdict.pass}, {"why", verdict.why}};
    pass = pass && verdict.pass;
  }
  return {{"months", has_validation ? "validation" : "three_months_left_out"},
          {"pass", outputs.empty() ? Json(nullptr) : Json(pass)},
          {"outputs", outputs}};
}

Json outputs_json(const assessment::AssessedCalibration& result) {
  Json list = Json::array();
  for (const assessment::OutputCalibration& output : result.outputs) {
    Json months = Json::array();
    for (std::size_t i = 0; i < result.month_names.size(); ++i) {
      const assessment::BoxPlot& box = output.assessment.boxes[i];
      months.push_back({{"month", result.month_names[i]},
                        {"role", name_of(result.roles[i])},
                        {with_unit("measured", output), results::number(output.measured[i])},
                        {"draws_q25", results::number(box.q25)},
                        {"draws_q50", results::number(box.q50)},
                        {"draws_q75", results::number(box.q75)}});
    }
    list.push_back(
        {{"name", output.name},
         {"meter", output.meter_id},
         {"unit", output.unit},
         {"weight", output.weight},
         {"calibrated", output.calibrated},
         {"not_fitted_because",
          output.not_fitted_because.empty() ? Json(nullptr) : Json(output.not_fitted_because)},
         {"model_weight", results::number(output.assessment.model_weight)},
         {"unreliable_months", output.assessment.forecast.unreliable_months},
         {"months", months}});
  }
  return list;
}

Json sensitivity_json(const assessment::AssessedCalibration& result) {
  if (!result.sensitivity) return nullptr;
  Json list = Json::array();
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    const calibration::ParameterSensitivity& s = result.sensitivity->parameters[j];
    list.push_back({{"name", result.parameters[j].name},
                    {"mean_at_smaller_discrepancy", results::number(s.mean_at_smaller)},
                    {"mean_at_larger_discrepancy", results::number(s.mean_at_larger)},
                    {"largest_move_sd", results::number(s.largest_move_sd)},
                    {"prior_driven", s.prior_driven}});
  }
  return {{"factor", result.sensitivity->factor}, {"parameters", list}};
}

Json sampling_json(const calibration::SamplingReport& report) {
  long divergences = 0;
  long depth_limit_hits = 0;
  Json acceptance = Json::array();
  Json e_bfmi = Json::array();
  for (const calibration::ChainStatistics& chain : report.chains) {
    divergences += chain.divergences;
    depth_limit_hits += chain.depth_limit_hits;
    acceptance.push_back(results::number(chain.acceptance_rate));
    e_bfmi.push_back(results::number(chain.e_bfmi));
  }
  return {{"draws", report.kept},
          {"doublings", report.doublings},
          {"taken_over", report.taken_over.empty() ? Json(nullptr) : Json(report.taken_over)},
          {"acceptance_rate", acceptance},
          {"divergences", divergences},
          {"depth_limit_hits", depth_limit_hits},
          {"e_bfmi", e_bfmi},
          {"density_evaluations", report.density_evaluations},
          {"gradient_evaluations", report.gradient_evaluations}};
}

Json evidence_json(const calibration::Calibration& calibration) {
  Json json = {{"by_bridge", shapes::json_of(calibration.evidence)}, {"by_populations", nullptr}};
  if (std::isfinite(calibration.sampling.log_evidence)) {
    json["by_populations"] = {{"log_evidence", results::number(calibration.sampling.log_evidence)},
                              {"mcse", results::number(calibration.sampling.log_evidence_se)}};
  }
  return json;
}

Json leave_out_json(const calibration::Calibration& calibration) {
  Json list = Json::array();
  for (const calibration::LeaveOutScore& score : calibration.leave_out) {
    list.push_back({{"months_left_out_together", score.block_months},
                    {"blocks", score.blocks},
                    {"elpd", results::number(score.elpd)},
                    {"se", results::number(score.standard_error)},
                    {"pareto_k_max", results::number(score.pareto_k_max)},
                    {"unreliable_blocks", score.unreliable}});
  }
  return list;
}

/// In units of prior standard deviations.
Json weak_directions_json(const assessment::AssessedCalibration& result) {
  Json list = Json::array();
  for (const calibration::WeakDirection& direction : result.calibration.weak_directions) {
    Json loadings = Json::object();
    for (std::size_t j = 0; j < result.parameters.size(); ++j) {
      loadings[result.parameters[j].name] =
          results::number(direction.loadings[static_cast<Eigen::Index>(j)]);
    }
    list.push_back(
        {{"information", results::number(direction.information)}, {"loadings", loadings}});
  }
  return list;
}

Json schedule_json(const model::HourlySchedule& schedule) {
  Json by_day = Json::object();
  for (std::size_t i = 0; i < model::kDayTypes; ++i) {
    Json by_hour = Json::array();
    for (int hour = 0; hour < 24; ++hour) {
      by_hour.push_back(results::number(schedule.at(static_cast<model::DayType>(i), hour)));
    }
    by_day[model::kDayTypeNames[i]] = by_hour;
  }
  return by_day;
}

Json profile_object(const model::ElectricityProfile& profile) {
  return {{"measured_kW", schedule_json(profile.measured_kW)},
          {"standard_error_kW", schedule_json(profile.standard_error_kW)},
          {"lights_kW", schedule_json(profile.loads.lights_kW)},
          {"plugs_kW", schedule_json(profile.loads.plugs_kW)},
          {"fans_and_pumps_kW", schedule_json(profile.known.fans_and_pumps_kW)},
          {"exterior_kW", profile.known.exterior_kW},
          {"standby_kW", profile.standby_kW},
          {"month_factor", profile.loads.month_factor},
          {"hours_used", profile.hours_used},
          {"monthly_cvrmse", results::number(profile.check.monthly_cvrmse)},
          {"check", profile.check.words}};
}

void add_follow_up(const FollowUp& follow_up, Json& json) {
  if (!follow_up) {
    json["drift_not_followed"] = follow_up.error();
    return;
  }
  json["drift"] = results::outputs_json(*follow_up);
  json["alarms"] = results::alarms_json(*follow_up);
  json["meter_changes"] = results::changed_meters_json(*follow_up);
}

Json months_json(const assessment::AssessedCalibration& result) {
  Json months = Json::array();
  for (std::size_t i = 0; i < result.month_names.size(); ++i) {
    months.push_back({{"month", result.month_names[i]}, {"role", name_of(result.roles[i])}});
  }
  return months;
}

Json forecast_json(const assessment::AssessedCalibration& result) {
  return fits_json(result, [](const auto& output) { return &output.assessment.forecast; });
}

Json yardstick_json(const assessment::AssessedCalibration& result) {
  return fits_json(result, [](const auto& output) {
    const auto& yardstick = output.assessment.yardstick;
    return yardstick ? &*yardstick : nullptr;
  });
}

/// No model was calibrated.
Json forecasts_alone_json(const assessment::AssessedCalibration& result, const RunFacts& facts) {
  Json json = {{"model", "change_point"},
               {"status", "forecast"},
               {"not_calibrated_because", result.not_calibrated_because},
               {"months", months_json(result)},
               {"parameters", Json::array()},
               {"forecast", forecast_json(result)},
               {"yardstick", yardstick_json(result)},
               {"unseen_months_within_limits", unseen_limits_json(result)},
               {"predictions", predictions_json(result)},
               {"warnings", warnings_json(result)}};
  views::add_provenance(facts, json);
  return json;
}

}  // namespace

std::string calibration_json(const assessment::AssessedCalibration& result, const RunFacts& facts,
                             const FollowUp* follow_up) {
  if (!result.not_calibrated_because.empty()) {
    Json json = forecasts_alone_json(result, facts);
    if (follow_up != nullptr) add_follow_up(*follow_up, json);
    return json.dump(2) + "\n";
  }
  Json hyperparameters = Json::array();
  for (const calibration::Summary& s : result.calibration.hyperparameters) {
    Json entry = shapes::json_of(s);
    entry["prior"] = {{"mean", results::number(s.prior_mean)}, {"sd", results::number(s.prior_sd)}};
    hyperparameters.push_back(std::move(entry));
  }
  const auto& calibration = result.calibration;
  Json json = {{"model", name_of(result.model)},
               {"status", calibration.converged ? "converged" : "unconverged"},
               {"months", months_json(result)},
               {"parameters", parameters_json(result)},
               {"fixed_parameters", fixed_parameters_json(result)},
               {"hyperparameters", hyperparameters},
               {"metamodel", metamodel_json(result)},
               {"forecast", forecast_json(result)},
               {"yardstick", yardstick_json(result)},
               {"before", stage_json(result, &assessment::OutputAssessment::before)},
               {"prior_mean", stage_json(result, &assessment::OutputAssessment::prior_mean)},
               {"after", stage_json(result, &assessment::OutputAssessment::after)},
               {"guideline14", guideline_json(result)},
               {"unseen_months_within_limits", unseen_limits_json(result)},
               {"predictions", predictions_json(result)},
               {"extrapolation", range_json(result, calibration.range.extrapolation)},
               {"range_fail", range_json(result, calibration.range.by_month)},
               {"prior_sensitivity", sensitivity_json(result)},
               {"warnings", warnings_json(result)},
               {"outputs", outputs_json(result)},
               {"sampler", facts.sampler},
               {"hyper_prior", calibration.hyper_prior.name},
               {"iterations", facts.iterations},
               {"burn_in", facts.burn_in},
               {"chains", facts.chains},
               {"design_runs", facts.design_runs},
               {"seed", facts.seed}};
  views::add_provenance(facts, json);
  json["sampling"] = sampling_json(calibration.sampling);
  json["evidence"] = evidence_json(calibration);
  json["leave_out"] = leave_out_json(calibration);
  json["weak_directions"] = weak_directions_json(result);
  if (follow_up != nullptr) add_follow_up(*follow_up, json);
  return json.dump(2) + "\n";
}

JobResult calibration_result(const assessment::AssessedCalibration& result, const RunFacts& facts,
                             const FollowUp* follow_up) {
  JobResult job{.document = calibration_json(result, facts, follow_up)};
  for (const auto* summaries :
       {&result.calibration.parameters, &result.calibration.hyperparameters}) {
    for (const calibration::Summary& s : *summaries) {
      job.rhat_max = std::fmax(job.rhat_max, s.rhat);
    }
  }
  if (follow_up != nullptr && *follow_up) job.drift = **follow_up;
  return job;
}

std::string draws_csv(const assessment::AssessedCalibration& result, std::size_t chain,
                      const RunFacts& facts) {
  const calibration::ChainDraws& draws = result.calibration.chains[chain];
  std::string text = fmt::format(
      "# model = {}\n# method = sample\n# num_samples = {}\n# num_warmup = {}\n# save_warmup = 0\n"
      "# thin = 1\n# sampler = {}\n# seed = {}\n# id = {}\nlp__,accept_stat__",
      facts.model_version, draws.log_density.size(), facts.burn_in, facts.sampler, facts.seed,
      chain + 1);
  for (const Parameter& parameter : result.parameters) text += "," + parameter.name;
  for (const calibration::Summary& s : result.calibration.hyperparameters) text += "," + s.name;
  const calibration::ChainPredictions* predictions = nullptr;
  if (result.calibration.predictions) {
    predictions = &result.calibration.predictions->chains[chain];
    for (const char* name : {"y_rep", "log_lik"}) {
      for (std::size_t p = 1; p <= result.calibration.predictions->points.size(); ++p) {
        text += fmt::format(",{}.{}", name, p);
      }
    }
  }
  text += '\n';
  auto out = std::back_inserter(text);
  for (Eigen::Index i = 0; i < draws.log_density.size(); ++i) {
    fmt::format_to(out, "{:.10g},{:.4g}", draws.log_density[i], draws.acceptance_rate);
    for (const double value : draws.theta.row(i)) fmt::format_to(out, ",{:.10g}", value);
    fmt::format_to(out, ",{:.10g},{:.10g}", draws.discrepancy_precision[i],
                   draws.error_precision[i]);
    for (const double value : draws.beta.row(i)) fmt::format_to(out, ",{:.10g}", value);
    if (predictions != nullptr) {
      for (const double value : predictions->replicates.row(i)) {
        fmt::format_to(out, ",{:.7g}", value);
      }
      for (const double value : predictions->log_likelihood.row(i)) {
        fmt::format_to(out, ",{:.10g}", value);
      }
    }
    text += '\n';
  }
  return text;
}

std::string points_json(const assessment::AssessedCalibration& result) {
  Json json = {{"y", Json::array()},
               {"output", Json::array()},
               {"unit", Json::array()},
               {"month", Json::array()}};
  for (const calibration::PointIndex& point : result.calibration.predictions->points) {
    const auto& output = result.outputs[static_cast<std::size_t>(point.output)];
    const auto month = static_cast<std::size_t>(point.month);
    json["y"].push_back(output.measured[month]);
    json["output"].push_back(output.name);
    json["unit"].push_back(output.unit);
    json["month"].push_back(result.month_names[month]);
  }
  return json.dump(2) + "\n";
}

std::string months_csv(const Recording& recording, const std::string& tzdata) {
  std::string text = kMonthsHeader;
  for (const MeterRecord& record : recording.meters) {
    for (const metering::MonthlyFigure& figure : record.figures) {
      const std::string value = std::isfinite(figure.daily_average_kWh)
                                    ? fmt::format("{:.6g}", figure.daily_average_kWh)
                                    : "";
      const std::string peak = figure.peak ? fmt::format("{:.6g}", figure.peak->kW) : "";
      const std::string peak_at = figure.peak ? metering::to_string(figure.peak->start) : "";
      text += fmt::format(
          "{},{},{},kWh/day,{:.6f},{:.6f},{},{},block-{}s,{},{},{},{},{:.6f},{}\n",
          metering::to_string(figure.month), record.meter.id, value, figure.coverage,
          figure.filled_share, peak, peak_at, figure.peak_window.count(),
          figure.usable ? "yes" : "no", is_site_different(recording, figure.month) ? "yes" : "no",
          figure.revision, tzdata, figure.estimated_share,
          value.empty() ? ""
                        : fmt::format("{:.4g}", std::sqrt(figure.daily_average_variance_kWh2)));
    }
  }
  return text;
}

std::string months_csv(const DesignCalibration& result) {
  std::vector<std::string> names;
  for (const assessment::OutputCalibration& output : result.outputs) names.push_back(output.name);
  std::string text = kMonthsHeader;
  for (const regression::MeterOutputs& meter : regression::group_by_meter(names)) {
    const auto value_of = [&](int output, std::size_t month) {
      const double value =
          output < 0 ? kAbsent : result.outputs[static_cast<std::size_t>(output)].measured[month];
      return std::isnan(value) ? std::string{} : fmt::format("{:.6g}", value);
    };
    const std::string unit = meter.consumption < 0
                                 ? "kWh/day"
                                 : result.outputs[static_cast<std::size_t>(meter.consumption)].unit;
    const auto first = static_cast<std::size_t>(meter.existing().front());
    const std::string& id = meter.meter.empty() ? names[first] : meter.meter;
    for (const std::size_t i : in_order_of_time(result.months)) {
      const std::string value = value_of(meter.consumption, i);
      const std::string peak = value_of(meter.peak, i);
      text += fmt::format("{},{},{},{},,,{},,,{},,,,,\n", result.month_names[i], id, value, unit,
                          peak, value.empty() && peak.empty() ? "no" : "yes");
    }
  }
  return text;
}

std::string profile_json(const model::ElectricityProfile& profile) {
  return profile_object(profile).dump(2) + "\n";
}

}  // namespace recald::daemon
