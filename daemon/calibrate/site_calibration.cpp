#include "daemon/calibrate/site_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "core/model/epc/prepare.hpp"
#include "core/model/hourly/hourly_model.hpp"
#include "core/model/hourly/prepare.hpp"
#include "core/weather/monthly_inputs.hpp"

namespace recald::daemon {
namespace {

using assessment::MonthRole;
using metering::Month;
using model::epc::EpcModel;

// A month whose weather is mostly invented cannot be held against a model.
constexpr double kLeastWeatherCoverage = 0.5;
constexpr double kGoodWeatherCoverage = 0.9;
// One standard deviation of the share of lights and plugs that heats the zone, relative.
constexpr double kHeatShareSd = 0.15;
// The same of a meter's peaks: schedules are means over many days, and a month's highest quarter
// hour is not on a mean day. Their own scatter lifts measured peaks by about 8 %.
constexpr double kPeakSd = 0.08;

bool is_hourly(const SiteConfig& site) { return site.model && site.model->kind == "hourly"; }

struct Months {
  std::vector<Month> all;
  std::vector<MonthRole> roles;
  std::vector<Month> calibration;  ///< The leading part of `all`.
};

Months choose_months(const PeriodConfig& period, const SiteWeather& weather,
                     std::vector<std::string>& warnings) {
  Months months;
  const auto take = [&](const metering::MonthRange& range, MonthRole role) {
    for (Month month = range.first; month <= range.last; month = metering::next_month(month)) {
      const double coverage = weather_coverage(weather.filled, month);
      if (coverage < kLeastWeatherCoverage) {
        warnings.push_back(fmt::format("{} is left out: only {:.0f} % of its weather is known.",
                                       metering::to_string(month), 100.0 * coverage));
        continue;
      }
      if (coverage < kGoodWeatherCoverage) {
        warnings.push_back(fmt::format(
            "{}: only {:.0f} % of the weather was measured; the rest is typical of the month.",
            metering::to_string(month), 100.0 * coverage));
      }
      months.all.push_back(month);
      months.roles.push_back(role);
      if (role == MonthRole::calibration) months.calibration.push_back(month);
    }
  };
  take(period.calibration, MonthRole::calibration);
  if (period.validation) take(*period.validation, MonthRole::validation);
  return months;
}

/// A model needs at least one month with weather; without, later steps would blame the meters.
Result<void> require_months(const Months& months, const PeriodConfig& period,
                            const SiteWeather& weather) {
  if (!months.calibration.empty()) return {};
  const Month first = period.calibration.first;
  return failure(
      ErrorCode::not_enough_data,
      fmt::format("the weather covers no calibration month from {} to {} (of {} it has {:.0f} %); "
                  "give weather of these months, or change [period]",
                  metering::to_string(first), metering::to_string(period.calibration.last),
                  metering::to_string(first), 100.0 * weather_coverage(weather.filled, first)));
}

const metering::MonthlyFigure* find_figure(const MeterRecord& record, Month month) {
  const auto found = std::ranges::find(record.figures, month, &metering::MonthlyFigure::month);
  return found == record.figures.end() ? nullptr : &*found;
}

/// Main electricity meter: the first one of that utility.
const MeterRecord* electricity_meter(const Recording& recording) {
  const auto found = std::ranges::find_if(recording.meters, [](const MeterRecord& record) {
    return record.meter.utility == metering::Utility::electricity;
  });
  return found == recording.meters.end() ? nullptr : &*found;
}

std::vector<profile::HourlyLoad> loads_of(const MeterRecord& record,
                                          const std::vector<Month>& months) {
  std::vector<profile::HourlyLoad> loads;
  for (const Month month : months) {
    const auto found = record.hours.find(month);
    if (found == record.hours.end()) continue;
    loads.insert(loads.end(), found->second.begin(), found->second.end());
  }
  return loads;
}

Result<profile::ElectricityProfile> fit_site_profile(const SiteConfig& site,
                                                     const Recording& recording,
                                                     const model::epc::Place& place,
                                                     const std::vector<Month>& months) {
  const MeterRecord* meter = electricity_meter(recording);
  if (meter == nullptr) {
    return failure(ErrorCode::not_enough_data,
                   "the model takes lights and plugs from an electricity meter, and the site has "
                   "none; add a [[meter]] with utility = \"electricity\"");
  }
  if (is_hourly(site)) {
    return model::hourly::fit_profile_without_plant(loads_of(*meter, months), *site.building, place,
                                                    months);
  }
  if (site.building->chiller_cop) {
    return failure(
        ErrorCode::unsupported,
        "[building.cooling] chiller_cop: the monthly model's electricity profile cannot tell an "
        "own chiller from lights and plugs, and would count it twice; take kind = \"hourly\" "
        "(or --model hourly), or leave it out and do not model the cooling");
  }
  return model::epc::fit_profile_with_fans(loads_of(*meter, months), *site.building, place, months);
}

/// Whether the meter counts in another unit since: its figures are not the building's.
bool is_rescaled(const MeterRecord& record, Month month) {
  return std::ranges::any_of(record.level_changes, [&](const metering::LevelChange& change) {
    return change.kind == metering::LevelChangeKind::scale && month >= change.since &&
           (!change.back_since || month < *change.back_since);
  });
}

/// nullptr where the month's figure is missing or must not be calibrated against.
const metering::MonthlyFigure* usable_figure(const MeterRecord& record, Month month) {
  const metering::MonthlyFigure* figure = find_figure(record, month);
  return figure != nullptr && figure->usable && !is_rescaled(record, month) ? figure : nullptr;
}

OutputCalibration daily_output(const std::string& id, std::size_t meter, const MeterRecord& record,
                               const std::vector<Month>& months) {
  OutputCalibration output{
      .name = id + "_daily_kWh", .label = id, .unit = "kWh/day", .meter = meter};
  for (const Month month : months) {
    const metering::MonthlyFigure* figure = usable_figure(record, month);
    output.measured.push_back(figure ? figure->daily_average_kWh : kAbsent);
    output.extra_variances.push_back(figure ? figure->daily_average_variance_kWh2 : 0.0);
  }
  return output;
}

OutputCalibration peak_output(const std::string& id, std::size_t meter, const MeterRecord& record,
                              const std::vector<Month>& months) {
  OutputCalibration output{
      .name = id + "_peak_kW", .label = id + " peak", .unit = "kW", .meter = meter};
  for (const Month month : months) {
    const metering::MonthlyFigure* figure = usable_figure(record, month);
    output.measured.push_back(figure && figure->peak ? figure->peak->kW : kAbsent);
    output.extra_variances.push_back(0.0);
  }
  return output;
}

/// Each meter's daily averages and, where the model has them, its peaks. In this order
/// `hourly_outputs` asks the model for them.
std::vector<OutputCalibration> collect_outputs(const SiteConfig& site, const Recording& recording,
                                               const std::vector<Month>& months) {
  std::vector<OutputCalibration> outputs;
  for (const std::string& id : site.model->outputs) {
    const std::size_t meter = *site.meter_index(id);
    const MeterRecord& record = recording.meters[meter];
    const auto weight = site.model->weights.find(id);
    const auto add = [&](OutputCalibration output) {
      if (weight != site.model->weights.end()) output.weight = weight->second;
      outputs.push_back(std::move(output));
    };
    add(daily_output(id, meter, record, months));
    if (is_hourly(site)) add(peak_output(id, meter, record, months));
  }
  return outputs;
}

std::vector<model::hourly::OutputDefinition> hourly_outputs(std::size_t meters) {
  std::vector<model::hourly::OutputDefinition> outputs;
  for (int meter = 0; meter < static_cast<int>(meters); ++meter) {
    outputs.push_back({meter, model::hourly::OutputKind::daily_kWh});
    outputs.push_back({meter, model::hourly::OutputKind::peak_kW});
  }
  return outputs;
}

/// Makes the site's model of some months for a building that differs from the site's in values.
using ModelFactory = std::function<std::unique_ptr<MonthlyModel>(const model::Building&)>;

Result<ModelFactory> model_of(const SiteConfig& site, const SiteCalibration& so_far,
                              const std::vector<model::MeterMap>& maps,
                              const std::vector<Month>& months, const model::epc::Place& place) {
  if (!is_hourly(site)) {
    auto climate = model::epc::prepare_climate(months, *site.building, so_far.profile.loads, place);
    if (!climate) return tl::unexpected(climate.error());
    return [=, definitions = so_far.definitions,
            climate = std::move(*climate)](const model::Building& building) {
      return std::make_unique<EpcModel>(building, definitions, maps, climate);
    };
  }
  auto made = model::make_drivers(months, place.calendar, place.holidays, *site.building,
                                  so_far.profile.loads, place.location, place.weather);
  if (!made) return tl::unexpected(made.error());
  // Peaks are means over the meters' interval, so the model's steps are no longer than that.
  const int steps = site.interval < std::chrono::hours{1} ? 4 : 1;
  return [=, definitions = so_far.definitions,
          drivers = std::make_shared<const model::Drivers>(std::move(*made))](
             const model::Building& building) {
    return std::make_unique<model::hourly::HourlyModel>(
        building, definitions, maps, hourly_outputs(maps.size()), drivers,
        model::hourly::HourlyOptions{.steps_per_hour = steps});
  };
}

Result<void> choose_parameters(const SiteConfig& site, SiteCalibration& result) {
  for (const ParameterConfig& config : site.model->parameters) {
    const auto definition = model::find_parameter(config.name);
    if (!definition) return tl::unexpected(definition.error());
    const auto parameter = model::make_parameter(**definition, *site.building, config.prior);
    if (!parameter) return tl::unexpected(parameter.error());
    result.definitions.push_back(*definition);
    result.parameters.push_back(*parameter);
  }
  return {};
}

/// How all months move together when more or less of the lights and plugs heats the zone: the
/// profile fixes their power, not where it ends up.
Eigen::VectorXd heat_share_error(const model::Building& building, const ModelFactory& make,
                                 std::span<const double> theta) {
  model::Building less_heat = building;
  less_heat.use.zone_heat_share *= 1.0 - kHeatShareSd;
  const std::vector<double> base = evaluate(*make(building), theta);
  const std::vector<double> moved = evaluate(*make(less_heat), theta);
  return Eigen::Map<const Eigen::VectorXd>(base.data(), static_cast<Eigen::Index>(base.size())) -
         Eigen::Map<const Eigen::VectorXd>(moved.data(), static_cast<Eigen::Index>(moved.size()));
}

/// How all peaks of one meter move together, one error a meter that has them.
/// @param outputs  In the order of the model's.
std::vector<Eigen::VectorXd> peak_errors(const std::vector<OutputCalibration>& outputs,
                                         MonthlyModel& model, std::span<const double> theta) {
  const std::vector<double> base = evaluate(model, theta);
  const auto months = static_cast<Eigen::Index>(model.month_count());
  std::vector<Eigen::VectorXd> errors;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (outputs[k].unit != "kW") continue;
    Eigen::VectorXd error = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(base.size()));
    const auto first = static_cast<Eigen::Index>(k) * months;
    error.segment(first, months) =
        kPeakSd * Eigen::Map<const Eigen::VectorXd>(base.data() + first, months);
    errors.push_back(std::move(error));
  }
  return errors;
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

void warn_about_level_changes(const Recording& recording, SiteCalibration& result) {
  std::string months;
  for (const Month month : result.months) {
    if (!is_site_different(recording, month)) continue;
    months += (months.empty() ? "" : ", ") + metering::to_string(month);
  }
  if (months.empty()) return;
  result.warnings.push_back(fmt::format(
      "In {} a meter reads differently than in the same months before: these months may "
      "not show the building that the others show.",
      months));
}

void add_words(const Recording& recording, const SiteWeather& weather, SiteCalibration& result) {
  warn_about_level_changes(recording, result);
  if (!result.profile.check.constant) result.warnings.push_back(result.profile.check.words);
  result.warnings.insert(result.warnings.end(), weather.notes.begin(), weather.notes.end());
}

}  // namespace

Result<std::vector<model::MeterMap>> meter_maps(const SiteConfig& site) {
  std::vector<model::MeterMap> maps;
  for (const std::string& id : site.model->outputs) {
    const MeterConfig& config = site.meters[*site.meter_index(id)];
    if (config.end_uses) {
      maps.push_back(*config.end_uses);
      continue;
    }
    const auto map = model::default_meter_map(config.meter.utility);
    if (!map)
      return failure(map.error().code, fmt::format("meter '{}': {}", id, map.error().message));
    maps.push_back(*map);
  }
  return maps;
}

Result<profile::ElectricityProfile> profile_site(const SiteConfig& site,
                                                 const metering::LocalCalendar& calendar,
                                                 const Recording& recording,
                                                 const SiteWeather& weather) {
  std::vector<std::string> warnings;
  const Months months = choose_months(*site.period, weather, warnings);
  if (auto enough = require_months(months, *site.period, weather); !enough) {
    return tl::unexpected(enough.error());
  }
  const model::epc::Place place{calendar, site.holidays, *site.location, weather.filled.series};
  return fit_site_profile(site, recording, place, months.calibration);
}

Result<PreparedSite> prepare_site(const SiteConfig& site, const metering::LocalCalendar& calendar,
                                  const Recording& recording, const SiteWeather& weather) {
  PreparedSite prepared;
  SiteCalibration& result = prepared.so_far;
  const Months months = choose_months(*site.period, weather, result.warnings);
  if (auto enough = require_months(months, *site.period, weather); !enough) {
    return tl::unexpected(enough.error());
  }
  result.model = site.model->kind;
  result.months = months.all;
  for (const Month month : months.all) result.month_names.push_back(metering::to_string(month));
  result.roles = months.roles;
  if (const auto chosen = choose_parameters(site, result); !chosen) {
    return tl::unexpected(chosen.error());
  }
  const auto maps = meter_maps(site);
  if (!maps) return tl::unexpected(maps.error());

  const model::epc::Place place{calendar, site.holidays, *site.location, weather.filled.series};
  auto profile = fit_site_profile(site, recording, place, months.calibration);
  if (!profile) return tl::unexpected(profile.error());
  result.profile = std::move(*profile);
  result.outputs = collect_outputs(site, recording, months.all);

  const auto make = model_of(site, result, *maps, months.calibration, place);
  if (!make) return tl::unexpected(make.error());
  const auto make_whole = model_of(site, result, *maps, months.all, place);
  if (!make_whole) return tl::unexpected(make_whole.error());
  prepared.model = (*make)(*site.building);
  prepared.whole_model = (*make_whole)(*site.building);

  const auto inputs = weather::monthly_inputs(weather.filled.series, calendar, months.calibration);
  prepared.problem = problem_of(result, months.calibration.size());
  prepared.problem.inputs = {inputs.names, inputs.values};
  prepared.inputs =
      also_in(weather::monthly_inputs(weather.filled.series, calendar, months.all), inputs.names);
  prepared.problem.common_errors.push_back(
      heat_share_error(*site.building, *make, prior_modes(result.parameters)));
  for (Eigen::VectorXd& error :
       peak_errors(result.outputs, *prepared.model, prior_modes(result.parameters))) {
    prepared.problem.common_errors.push_back(std::move(error));
  }
  return prepared;
}

Result<SiteCalibration> calibrate_site(const SiteConfig& site,
                                       const metering::LocalCalendar& calendar,
                                       const Recording& recording, const SiteWeather& weather,
                                       const CalibrateOptions& options,
                                       const calibration::RunContext& context) {
  auto prepared = prepare_site(site, calendar, recording, weather);
  if (!prepared) return tl::unexpected(prepared.error());
  SiteCalibration result = std::move(prepared->so_far);
  auto design = calibration::run_design(*prepared->model, prepared->problem,
                                        options.calibration.design_runs, context);
  if (!design) return tl::unexpected(design.error());
  set_aside_unresponsive(*design, result, prepared->problem);
  if (auto done = calibrate_into(*prepared->model, prepared->problem, options.calibration,
                                 options.prior_sensitivity, std::move(*design), context, result);
      !done) {
    return tl::unexpected(done.error());
  }
  if (auto assessed = assess(*prepared->whole_model, context, result); !assessed) {
    return tl::unexpected(assessed.error());
  }
  add_words(recording, weather, result);
  return result;
}

}  // namespace recald::daemon
