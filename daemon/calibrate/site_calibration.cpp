#include "daemon/calibrate/site_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/model/epc/prepare.hpp"
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
  if (site.building->chiller_cop) {
    return failure(
        ErrorCode::unsupported,
        "[building.cooling] chiller_cop: the electricity profile cannot yet tell an own "
        "chiller from lights and plugs, and would count it twice; leave it out and do not "
        "model the cooling");
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

std::vector<OutputCalibration> collect_outputs(const SiteConfig& site, const Recording& recording,
                                               const std::vector<Month>& months) {
  std::vector<OutputCalibration> outputs;
  for (const std::string& id : site.model->outputs) {
    const std::size_t meter = *site.meter_index(id);
    const auto weight = site.model->weights.find(id);
    OutputCalibration output{
        .name = id + "_daily_kWh", .label = id, .unit = "kWh/day", .meter = meter};
    if (weight != site.model->weights.end()) output.weight = weight->second;
    for (const Month month : months) {
      const metering::MonthlyFigure* figure = find_figure(recording.meters[meter], month);
      const bool usable =
          figure != nullptr && figure->usable && !is_rescaled(recording.meters[meter], month);
      output.measured.push_back(usable ? figure->daily_average_kWh : kAbsent);
      output.extra_variances.push_back(usable ? figure->daily_average_variance_kWh2 : 0.0);
    }
    outputs.push_back(std::move(output));
  }
  return outputs;
}

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
Eigen::VectorXd heat_share_error(const model::Building& building, EpcModel& model,
                                 const std::vector<const model::ParameterDefinition*>& definitions,
                                 const std::vector<model::MeterMap>& maps,
                                 std::shared_ptr<const model::epc::ClimateClasses> climate,
                                 std::span<const double> theta) {
  model::Building less_heat = building;
  less_heat.use.zone_heat_share *= 1.0 - kHeatShareSd;
  EpcModel other{less_heat, definitions, maps, std::move(climate)};
  const std::vector<double> base = evaluate(model, theta);
  const std::vector<double> moved = evaluate(other, theta);
  return Eigen::Map<const Eigen::VectorXd>(base.data(), static_cast<Eigen::Index>(base.size())) -
         Eigen::Map<const Eigen::VectorXd>(moved.data(), static_cast<Eigen::Index>(moved.size()));
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

  const auto climate =
      model::epc::prepare_climate(months.calibration, *site.building, result.profile.loads, place);
  if (!climate) return tl::unexpected(climate.error());
  const auto whole_climate =
      model::epc::prepare_climate(months.all, *site.building, result.profile.loads, place);
  if (!whole_climate) return tl::unexpected(whole_climate.error());
  auto model = std::make_unique<EpcModel>(*site.building, result.definitions, *maps, *climate);
  prepared.whole_model =
      std::make_unique<EpcModel>(*site.building, result.definitions, *maps, *whole_climate);

  const auto inputs = weather::monthly_inputs(weather.filled.series, calendar, months.calibration);
  prepared.problem = problem_of(result, months.calibration.size());
  prepared.problem.inputs = {inputs.names, inputs.values};
  prepared.inputs =
      also_in(weather::monthly_inputs(weather.filled.series, calendar, months.all), inputs.names);
  prepared.problem.common_errors.push_back(heat_share_error(
      *site.building, *model, result.definitions, *maps, *climate, prior_modes(result.parameters)));
  prepared.model = std::move(model);
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
