#include "daemon/site/calibrate/site_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/absent.hpp"
#include "core/assessment/common_errors.hpp"
#include "core/assessment/level_forecast.hpp"
#include "core/assessment/metered_outputs.hpp"
#include "core/assessment/model_errors.hpp"
#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"
#include "core/model/epc/prepare.hpp"
#include "core/model/hourly/prepare.hpp"
#include "core/model/model_adaptors.hpp"
#include "core/text/number_text.hpp"
#include "core/weather/assumed_sky.hpp"
#include "core/weather/monthly_inputs.hpp"
#include "daemon/site/calibrate/effects_calibration.hpp"
#include "daemon/site/calibrate/meter_forecast.hpp"
#include "daemon/site/calibrate/site_on_runs.hpp"
#include "daemon/site/calibrate/yardstick.hpp"
#include "daemon/site/model/diagnosis_input.hpp"
#include "daemon/site/model/site_model.hpp"
#include "daemon/site/model/site_parts.hpp"

namespace recald::daemon {
namespace {

using assessment::MonthRole;
using metering::Month;

constexpr const char* kNoModel =
    "The site has no [[model]]: with a [building] and a [[model]] its parameters are calibrated.";

/// A model needs at least one month with weather; without, later steps would blame the meters.
Result<void> require_months(const SiteMonths& months, const PeriodConfig& period,
                            const SiteWeather& weather) {
  if (!months.calibration.empty()) return {};
  const Month first = period.calibration.first;
  return failure(
      ErrorCode::not_enough_data,
      fmt::format("the weather covers no calibration month from {} to {} (of {} it has {:.0f} %); "
                  "give weather of these months, or change [period]",
                  metering::to_string(first), metering::to_string(period.calibration.last),
                  metering::to_string(first), 100.0 * weather_coverage(weather, first)));
}

/// The columns whose names are among `names`.
weather::MonthlyInputs also_in(const weather::MonthlyInputs& inputs,
                               const std::vector<std::string>& names) {
  std::vector<Eigen::Index> columns;
  weather::MonthlyInputs kept;
  for (std::size_t j = 0; j < inputs.names.size(); ++j) {
    if (std::ranges::find(names, inputs.names[j]) == names.end()) continue;
    columns.push_back(static_cast<Eigen::Index>(j));
    kept.names.push_back(inputs.names[j]);
  }
  kept.values = inputs.values(Eigen::all, columns);
  return kept;
}

/// "Chilled water: 7 of 24 months are unlike the same months before, the worst July 2023 (+31 %)."
void warn_about_level_changes(const Recording& recording, SiteCalibration& result) {
  for (const MeterRecord& record : recording.meters) {
    std::string months;
    int count = 0;
    for (const Month month : result.months) {
      if (!metering::is_different(record.level_changes, month)) continue;
      months += (months.empty() ? "" : ", ") + display::month_words(metering::to_string(month));
      ++count;
    }
    if (count == 0) continue;
    const metering::LevelChange& worst = *std::ranges::max_element(
        record.level_changes, {},
        [](const metering::LevelChange& change) { return std::abs(std::log(change.ratio)); });
    result.warnings.push_back(
        {.sentence = fmt::format(
             "{}: {} of {} months {} unlike the same months before, the worst {} ({}).",
             display::meter_label(record.meter.id), count, result.months.size(),
             count == 1 ? "is" : "are", display::month_words(metering::to_string(worst.since)),
             signed_percent_text(worst.ratio - 1.0)),
         .details =
             fmt::format("Another level: {}. These months may not show the building that the "
                         "others show.",
                         months),
         .share = count / static_cast<double>(result.months.size())});
  }
}

/// A wide prior lets a parameter go where no building lies, and it goes there when something else
/// is missing.
void warn_about_unusual_parameters(const SiteConfig& site, SiteCalibration& result) {
  if (!facts_of(result.model).is_of_building) return;  // a client's model has values of its own
  for (std::size_t j = 0; j < site.model->parameters.size(); ++j) {
    const auto usual = model::make_parameter(*result.parameters[j].definition, *site.building);
    if (!usual) continue;
    const calibration::Summary& found = result.calibration.parameters[j];
    if (usual->prior.min() <= found.mean && found.mean <= usual->prior.max()) continue;
    const display::Unit unit = display::unit_of(site.units, found.unit);
    result.alarms.push_back(
        {fmt::format("{} came out at {:.3g}{}{}; in buildings like this it is {:.3g} to {:.3g}.",
                     result.parameters[j].label, unit.shown(found.mean),
                     unit.name.empty() ? "" : " ", unit.name, unit.shown(usual->prior.min()),
                     unit.shown(usual->prior.max())),
         "The drawings may be wrong, or something that the model lacks is read as this."});
  }
}

void add_words(const Recording& recording, const SiteWeather& weather, SiteCalibration& result) {
  warn_about_level_changes(recording, result);
  display::add_notes(recording.notes, result.warnings);
  if (facts_of(result.model).is_of_building && !result.profile.check.constant) {
    result.warnings.push_back(display::warning_of(result.profile.check.words));
  }
  display::add_notes(weather.notes, result.warnings);
}

/// Makes the effects ready and counts their parameters among the site's.
Result<void> take_effects(const SiteConfig& site, const metering::LocalCalendar& calendar,
                          const Recording& recording, const SiteWeather& weather,
                          std::vector<diagnosis::AddedEffect> added, SiteCalibration& result) {
  if (added.empty()) return {};
  auto problem = TRY(make_site_problem(site, calendar, recording, weather));
  auto effects = TRY(diagnosis::make_model_effects(
      std::move(added), std::make_shared<const diagnosis::SiteProblem>(std::move(problem))));
  for (std::size_t j = 0; j < effects.parameters.size(); ++j) {
    Parameter& taken = result.parameters.emplace_back(effects.parameters[j]);
    taken.definition = &effects.labels[j]->definition;
    taken.label = taken.definition->label;
  }
  result.effects = std::make_shared<const diagnosis::ModelEffects>(std::move(effects));
  // Factors of calendar months hold what an effect changes from month to month: it would count
  // twice. The diagnosis went without them too.
  result.profile.loads.month_factor.fill(1.0);
  return {};
}

/// Makes the model of all months. Effects are told dates, so an hourly one of theirs runs in order
/// of time.
Result<ModelFactory> whole_model_of(const SiteConfig& site, const SiteModelParts& parts,
                                    const SiteMonths& months, const model::epc::Place& place) {
  if (!parts.effects || !is_hourly(site) || std::ranges::is_sorted(months.all)) {
    return model_of(site, parts, months.all, place);
  }
  auto first = model_of(site, parts, months.calibration, place);
  if (!first) return first;
  auto second = model_of(
      site, parts, {months.all.begin() + std::ssize(months.calibration), months.all.end()}, place);
  if (!second) return second;
  return [first = std::move(*first), second = std::move(*second)](const model::Building& building) {
    return std::make_unique<JoinedMonthsModel>(first(building), second(building));
  };
}

/// Errors of one standard deviation, one for each variable of the weather that is assumed: how all
/// months move when it is wrong in all of them.
Result<std::vector<Eigen::VectorXd>> assumed_weather_errors(
    const SiteConfig& site, const SiteModelParts& parts, const SiteMonths& months,
    const model::epc::Place& place, const SiteWeather& weather, MonthlyModel& model,
    std::span<const double> theta) {
  std::vector<Eigen::VectorXd> errors;
  if (weather.assumed.empty()) return errors;
  const auto run = [&](MonthlyModel& one) {
    const std::vector<double> outputs = evaluate(one, theta);
    return Eigen::VectorXd{Eigen::Map<const Eigen::VectorXd>(
        outputs.data(), static_cast<Eigen::Index>(outputs.size()))};
  };
  const Eigen::VectorXd base = run(model);
  for (const std::size_t variable : weather.assumed) {
    weather::WeatherSeries altered = weather.filled.series;
    weather::assume_sky(altered, place.location, std::array{variable}, weather::kSkyErrorSd);
    const auto make = TRY(whole_model_of(
        site, parts, months, {place.calendar, place.holidays, place.location, altered}));
    errors.push_back(run(*make(*site.building)) - base);
  }
  return errors;
}

}  // namespace

void add_common_errors(const std::vector<Eigen::VectorXd>& errors,
                       const std::vector<assessment::CommonError>& kinds, PreparedSite& prepared) {
  const auto all = static_cast<Eigen::Index>(prepared.so_far.months.size());
  const auto first = static_cast<Eigen::Index>(prepared.problem.month_names.size());
  for (const Eigen::VectorXd& error : errors) {
    prepared.common_errors.push_back(error);
    prepared.problem.common_errors.push_back(assessment::leading_months(error, all, first));
  }
  prepared.errors.insert(prepared.errors.end(), kinds.begin(), kinds.end());
  prepared.errors.resize(prepared.common_errors.size());
}

void add_inputs(const metering::LocalCalendar& calendar, const SiteWeather& weather,
                const SiteMonths& months, PreparedSite& prepared) {
  weather::WeatherSeries series = weather.filled.series;
  // What is assumed follows the temperature: a discrepancy must not seem to follow it.
  for (const std::size_t variable : weather.assumed) {
    for (weather::WeatherHour& hour : series.hours) {
      hour.*weather::kWeatherVariables[variable].member = kAbsent;
    }
  }
  const auto inputs = weather::monthly_inputs(series, calendar, months.calibration);
  prepared.problem.inputs = {inputs.names, inputs.values};
  prepared.inputs = also_in(weather::monthly_inputs(series, calendar, months.all), inputs.names);
}

Result<BegunSite> begin_site(const SiteConfig& site, const Recording& recording,
                             const SiteWeather& weather) {
  BegunSite begun;
  SiteCalibration& result = begun.so_far;
  begun.months = choose_months(*site.period, weather, result.warnings);
  TRY(require_months(begun.months, *site.period, weather));
  result.model = site.model->kind;
  result.units = site.units;
  take_months(begun.months, result);
  result.outputs = collect_outputs(site, recording, begun.months.all);
  return begun;
}

std::vector<assessment::OutputCalibration> collect_outputs(const SiteConfig& site,
                                                           const Recording& recording,
                                                           const std::vector<Month>& months) {
  std::vector<assessment::OutputCalibration> outputs;
  for (const std::string& id : site.model->outputs) {
    const std::size_t meter = *site.meter_index(id);
    const MeterRecord& record = recording.meters[meter];
    const auto weight = site.model->weights.find(id);
    const auto add = [&](assessment::OutputCalibration output) {
      if (weight != site.model->weights.end()) output.weight = weight->second;
      outputs.push_back(std::move(output));
    };
    const assessment::MeteredMonths metered{id, meter, record.meter.utility, record.figures,
                                            record.level_changes};
    add(assessment::daily_output(metered, months));
    if (facts_of(site.model->kind).has_peaks) add(assessment::peak_output(metered, months));
  }
  return outputs;
}

Result<model::ElectricityProfile> fit_site_profile(const SiteConfig& site,
                                                   const Recording& recording,
                                                   const model::epc::Place& place,
                                                   const std::vector<Month>& months) {
  const auto meter = TRY(electricity_meter(site, recording));
  const std::vector<model::HourlyLoad> loads = loads_of(*meter, months);
  // What an own chiller draws is not told from lights and plugs by months, only by hours.
  if (is_hourly(site) || site.building->chiller_cop) {
    return model::hourly::fit_profile_without_plant(loads, *site.building, place, months);
  }
  return model::epc::fit_profile_with_fans(loads, *site.building, place, months);
}

Result<model::ElectricityProfile> profile_site(const SiteConfig& site,
                                               const metering::LocalCalendar& calendar,
                                               const Recording& recording,
                                               const SiteWeather& weather) {
  if (!site.building) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("{} has no [building], whose installed lights and plugs split the "
                               "electricity meter into a profile",
                               site.file.filename().string()));
  }
  display::Warnings warnings;
  const SiteMonths months = choose_months(*site.period, weather, warnings);
  TRY(require_months(months, *site.period, weather));
  const model::epc::Place place{calendar, site.holidays, *site.location, weather.filled.series};
  return fit_site_profile(site, recording, place, months.calibration);
}

void take_months(const SiteMonths& months, SiteCalibration& result) {
  result.months = months.all;
  result.roles = months.roles;
  for (const Month month : months.all) {
    result.month_names.push_back(metering::to_string(month));
    result.month_days.push_back(metering::days_in(month));
  }
}

Result<PreparedSite> prepare_site(const SiteConfig& site, const metering::LocalCalendar& calendar,
                                  const Recording& recording, const SiteWeather& weather,
                                  std::vector<diagnosis::AddedEffect> added) {
  if (!facts_of(site.model->kind).is_of_building) {
    return prepare_on_runs(site, calendar, recording, weather);
  }
  auto begun = TRY(begin_site(site, recording, weather));
  PreparedSite prepared{.so_far = std::move(begun.so_far)};
  const SiteMonths& months = begun.months;
  SiteCalibration& result = prepared.so_far;
  result.parameters = TRY(site_parameters(site));
  auto maps = TRY(meter_maps(site));

  const model::epc::Place place{calendar, site.holidays, *site.location, weather.filled.series};
  result.profile = TRY(fit_site_profile(site, recording, place, months.calibration));
  SiteModelParts parts{definitions_of(result.parameters), std::move(maps), {}, {}, {}};
  TRY(take_effects(site, calendar, recording, weather, std::move(added), result));
  parts.loads = result.profile.loads;
  parts.effects = result.effects;
  if (parts.effects && !is_hourly(site)) {
    const std::span<const Parameter> theta{result.parameters};
    parts.monthly = parts.effects->monthly(theta.first(parts.definitions.size()));
  }

  const auto make = TRY(model_of(site, parts, months.calibration, place));
  prepared.model = make(*site.building);
  auto whole = TRY(whole_model_of(site, parts, months, place));
  prepared.whole_model = whole(*site.building);

  const std::vector<double> modes = prior_modes(result.parameters);
  const auto of_weather = TRY(
      assumed_weather_errors(site, parts, months, place, weather, *prepared.whole_model, modes));

  prepared.parts = parts;
  parts.loads = assessment::more_use(parts.loads);
  const auto with_more = TRY(whole_model_of(site, parts, months, place));
  prepared.electricity_use =
      assessment::gain_by_use(*prepared.whole_model, *with_more(*site.building), modes);

  prepared.problem = assessment::problem_of(result, months.calibration.size());
  add_inputs(calendar, weather, months, prepared);
  const auto errors = [&](const ModelFactory& factory, MonthlyModel& model) {
    return assessment::common_errors(*site.building, factory, result.outputs, model, modes);
  };
  prepared.problem.common_errors = errors(make, *prepared.model);
  prepared.common_errors = errors(whole, *prepared.whole_model);
  prepared.errors = assessment::kinds_of_common_errors(result.outputs);
  add_common_errors(of_weather, {}, prepared);
  return prepared;
}

namespace {

/// Lights and plugs are not the same in every month, which no schedule tells.
void add_use_scatter(std::size_t k, SiteCalibration& result,
                     calibration::CalibrationProblem& problem) {
  assessment::OutputCalibration& output = result.outputs[k];
  double sum = 0.0;
  for (const double value : problem.outputs[k].values) sum += std::isnan(value) ? 0.0 : value;
  const int months = problem.outputs[k].measured_months();
  if (months == 0) return;
  const double sd = assessment::kProfiledLevel.scatter * sum / months;
  for (auto* variances : {&output.extra_variances, &problem.outputs[k].extra_variances}) {
    for (double& variance : *variances) variance += sd * sd;
  }
}

/// Whether an output is no evidence for the model, and why.
/// Lights and plugs that were read off a meter fit it by construction, and plant behind it was
/// taken from it as the drawings have it. A month's highest quarter hour is not an average day.
std::optional<std::string> why_no_evidence(const assessment::OutputCalibration& output,
                                           std::size_t profiled) {
  if (output.unit == "kW") {
    return "Schedules describe average days, so a month's peak is no evidence for the model. It is "
           "forecast from the model's errors in it and in the fitted meters.";
  }
  if (output.meter != profiled) return std::nullopt;
  return "The model's lights and plugs were read off this meter, so it is no evidence for the "
         "model; it is followed by its level.";
}

/// Sets aside what is no evidence. Where too little else is metered that the parameters move, the
/// meter that was read is fitted all the same, with the profile's doubt as a common error.
/// @pre unresponsive outputs are set aside
void take_evidence(const SiteConfig& site, const assessment::ModelErrorSizes& sizes,
                   PreparedSite& prepared) {
  SiteCalibration& result = prepared.so_far;
  // Of a client's model nothing was read off a meter.
  const std::size_t profiled =
      facts_of(site.model->kind).is_of_building ? *profile_meter(site) : site.meters.size();
  int other_figures = 0;
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    const auto& output = result.outputs[k];
    if (output.unit == "kW" || output.meter == profiled) continue;
    other_figures += prepared.problem.outputs[k].measured_months();
  }
  const bool is_only =
      other_figures < std::ssize(result.parameters) + calibration::kPointsBeyondParameters;
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    if (!result.outputs[k].calibrated) continue;
    const bool is_peak = result.outputs[k].unit == "kW";
    if (is_only && !is_peak && result.outputs[k].meter == profiled) {
      add_use_scatter(k, result, prepared.problem);
      const auto& use = prepared.electricity_use;
      const Eigen::VectorXd level =
          sizes.electricity_level *
          Eigen::Map<const Eigen::VectorXd>(use.data(), static_cast<Eigen::Index>(use.size()));
      add_common_errors({level}, {}, prepared);
    } else if (auto why = why_no_evidence(result.outputs[k], profiled)) {
      using enum assessment::Following;
      assessment::set_aside(k, std::move(*why), is_peak ? errors : level, result, prepared.problem);
    }
  }
}

/// A model's error in a parameter is of the size of what is usual, which the library knows. Who
/// gives a wider prior knows less; a floor area that nobody has told is no error of the model, and
/// neither is an effect that was added to it.
std::vector<double> parameter_spreads(const SiteConfig& site,
                                      const assessment::ModelErrorSizes& sizes,
                                      SiteCalibration& result) {
  if (!facts_of(result.model).is_of_building) {
    result.parameter_errors.assign(result.parameters.size(), sizes.parameter_share);
    return assessment::spreads_of(result.parameters, sizes);
  }
  std::vector<double> spreads(result.parameters.size(), 0.0);
  result.parameter_errors.assign(result.parameters.size(), 0.0);
  for (std::size_t j = 0; j < site.model->parameters.size(); ++j) {
    const model::ParameterDefinition& definition = *result.parameters[j].definition;
    if (definition.group == "geometry") continue;
    const double own = std::sqrt(result.parameters[j].prior.variance());
    const auto usual = model::make_parameter(definition, *site.building);
    const double known = usual ? std::sqrt(usual->prior.variance()) : own;
    spreads[j] = sizes.parameter_share * std::min(own, known);
    result.parameter_errors[j] = spreads[j] / own;
  }
  return spreads;
}

/// As learnt, where the site does not know better.
assessment::ModelErrorSizes sizes_of(const ModelConfig& model) {
  const assessment::ModelErrorSizes& learnt = assessment::model_error_sizes(model.kind);
  const ModelErrorsConfig& own = model.errors;
  return {.parameter_share = own.parameter_share.value_or(learnt.parameter_share),
          .cooling_level = own.cooling_level.value_or(learnt.cooling_level),
          .heating_level = own.heating_level.value_or(learnt.heating_level),
          .electricity_level = own.electricity_level.value_or(learnt.electricity_level)};
}

/// Why the parameters cannot be calibrated: too few figures are left of meters that they move.
std::optional<std::string> why_too_little(const SiteConfig& site, const PreparedSite& prepared) {
  const int points = calibration::measured_points(prepared.problem);
  const SiteCalibration& so_far = prepared.so_far;
  const std::size_t parameters =
      so_far.effects ? site.model->parameters.size() : so_far.parameters.size();
  const int needed = static_cast<int>(parameters) + calibration::kPointsBeyondParameters;
  if (points >= needed) return std::nullopt;
  std::string why = fmt::format(
      "The model is not calibrated: its parameters need at least {} monthly figures of meters that "
      "they move, and there {} {}.",
      needed, points == 1 ? "is" : "are", points);
  for (const assessment::OutputCalibration& output : prepared.so_far.outputs) {
    if (output.unit == "kW" || output.not_fitted_because.empty()) continue;
    why += fmt::format(" {} is not fitted. {}", display::meter_label(output.meter_id),
                       output.not_fitted_because);
  }
  return why;
}

/// What the seed's discrepancy leaves out: see assessment/model_errors.hpp.
void add_model_errors(const SiteConfig& site, PreparedSite& prepared) {
  SiteCalibration& result = prepared.so_far;
  const assessment::ModelErrorSizes sizes = sizes_of(*site.model);
  const std::vector<double> spreads = parameter_spreads(site, sizes, result);
  take_evidence(site, sizes, prepared);
  std::vector<assessment::Service> services;
  for (const assessment::OutputCalibration& output : result.outputs) {
    services.push_back(assessment::service_of(site.meters[output.meter].meter.utility));
  }
  auto errors =
      assessment::model_errors(*prepared.whole_model, result.parameters, spreads, services, sizes);
  add_common_errors(errors, assessment::kinds_of_model_errors(spreads, services, sizes), prepared);
}

}  // namespace

Result<void> calibrate_all(PreparedSite& prepared, const CalibrateOptions& options,
                           calibration::DesignRuns design, const calibration::RunContext& context,
                           SiteCalibration& result) {
  return assessment::calibrate_into(*prepared.model, prepared.problem, options.calibration,
                                    options.prior_sensitivity, std::move(design), context, result);
}

Result<SiteCalibration> calibrate_site(const SiteConfig& site,
                                       const metering::LocalCalendar& calendar,
                                       const Recording& recording, const SiteWeather& weather,
                                       const CalibrateOptions& options,
                                       const calibration::RunContext& context,
                                       std::vector<diagnosis::AddedEffect> added) {
  const auto forecast_alone = [&](std::string because) {
    return forecast_meters(site, calendar, recording, weather, std::move(because));
  };
  if (!site.model) return forecast_alone(kNoModel);
  auto prepared = TRY(prepare_site(site, calendar, recording, weather, std::move(added)));
  auto design = TRY(calibration::run_design(*prepared.model, prepared.problem,
                                            options.calibration.design_runs, context));
  assessment::set_aside_unresponsive(design, prepared.so_far, prepared.problem);
  CalibrateOptions how = options;
  if (options.discrepancy == DiscrepancyForm::sound) {
    add_model_errors(site, prepared);
    // Whoever names a sampler gets the model itself in the chains; a meta-model is fast already.
    how.calibration.emulate = options.calibration.sampling.sampler == nullptr &&
                              facts_of(site.model->kind).is_of_building;
  }
  if (auto why = why_too_little(site, prepared)) return forecast_alone(std::move(*why));
  SiteCalibration result = std::move(prepared.so_far);
  TRY(result.effects ? calibrate_with_effects(prepared, how, std::move(design), context, result)
                     : calibrate_all(prepared, how, std::move(design), context, result));
  result.with = std::make_shared<const CalibratedWith>(CalibratedWith{
      std::move(prepared.problem), std::move(prepared.errors), std::move(prepared.parts)});
  const assessment::WholePeriod whole{{prepared.inputs.names, prepared.inputs.values},
                                      std::move(prepared.common_errors)};
  const auto yardsticks = yardsticks_of(site, calendar, recording, weather, result);
  TRY(assessment::assess(*prepared.whole_model, whole, yardsticks, context, result));
  warn_about_unusual_parameters(site, result);
  add_words(recording, weather, result);
  return result;
}

}  // namespace recald::daemon
