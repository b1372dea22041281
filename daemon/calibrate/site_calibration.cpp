#include "daemon/calibrate/site_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/design/model_runs.hpp"
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
// An output that the whole design moves by less than this share of its mean tells nothing about the
// parameters that Guideline 14's tolerance of ±5 % would not also forgive.
constexpr double kLeastResponse = 0.10;
// The predictive noise has a random stream of its own, far from those of the chains.
constexpr std::uint64_t kPredictiveStream = 1'000'000;

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

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
    OutputCalibration output{.meter = meter, .name = id + "_daily_kWh"};
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

std::vector<double> prior_points(const std::vector<Parameter>& parameters, bool mode) {
  std::vector<double> theta;
  for (const Parameter& p : parameters) theta.push_back(mode ? p.prior.mode : p.prior.mean());
  return theta;
}

std::vector<double> evaluate(MonthlyModel& model, std::span<const double> theta) {
  std::vector<double> outputs(static_cast<std::size_t>(model.output_count() * model.month_count()));
  model.evaluate(theta, outputs);
  return outputs;
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

calibration::CalibrationProblem make_problem(const SiteCalibration& result,
                                             const weather::MonthlyInputs& inputs,
                                             std::size_t calibration_months) {
  calibration::CalibrationProblem problem;
  problem.parameters = result.parameters;
  for (std::size_t i = 0; i < calibration_months; ++i) {
    problem.month_names.push_back(metering::to_string(result.months[i]));
  }
  for (const OutputCalibration& output : result.outputs) {
    const auto n = static_cast<std::ptrdiff_t>(calibration_months);
    problem.outputs.push_back(
        {.name = output.name,
         .unit = "kWh/day",
         .values = {output.measured.begin(), output.measured.begin() + n},
         .extra_variances = {output.extra_variances.begin(), output.extra_variances.begin() + n},
         .weight = output.weight});
  }
  problem.inputs = {inputs.names, inputs.values};
  return problem;
}

/// Outputs that the parameters hardly move are taken out of the fit. Electricity fixed by its own
/// profile is one: normalised by a range of two per cent, its harmless misfit would set the size of
/// the discrepancy for all outputs.
void set_aside_unresponsive(const calibration::DesignRuns& design, SiteCalibration& result,
                            calibration::CalibrationProblem& problem) {
  const auto months = static_cast<Eigen::Index>(problem.month_names.size());
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    const auto block = design.outputs.middleCols(static_cast<Eigen::Index>(k) * months, months);
    const double spread = (block.colwise().maxCoeff() - block.colwise().minCoeff()).maxCoeff();
    if (spread > kLeastResponse * std::abs(block.mean())) continue;
    result.outputs[k].calibrated = false;
    std::ranges::fill(problem.outputs[k].values, kAbsent);
    result.warnings.push_back(fmt::format(
        "{}: the calibration parameters move it by {:.1f} % at most, so it is shown against the "
        "model and not fitted.",
        result.outputs[k].name, 100.0 * spread / std::abs(block.mean())));
  }
}

Eigen::VectorXd spread_sds(const calibration::Calibration& calibration, std::size_t output,
                           double weight) {
  const calibration::ThinnedDraws& thinned = calibration.thinned;
  const double range = calibration.normalisation.scales[output].range();
  Eigen::VectorXd sd(static_cast<Eigen::Index>(thinned.chain.size()));
  for (std::size_t d = 0; d < thinned.chain.size(); ++d) {
    const auto& chain = calibration.chains[static_cast<std::size_t>(thinned.chain[d])];
    const int row = thinned.iteration[d];
    const double variance =
        1.0 / chain.discrepancy_precision[row] + 1.0 / chain.error_precision[row];
    // A doubted output has its own share of error on top, as in the likelihood.
    sd[static_cast<Eigen::Index>(d)] = range * std::sqrt(variance / weight);
  }
  return sd;
}

Result<void> assess(EpcModel& model, const calibration::RunContext& context,
                    SiteCalibration& result) {
  const std::vector<double> at_mode = evaluate(model, prior_points(result.parameters, true));
  const std::vector<double> at_mean = evaluate(model, prior_points(result.parameters, false));
  const Eigen::VectorXd& mean = result.calibration.posterior_mean;
  const std::vector<double> after =
      evaluate(model, {mean.data(), static_cast<std::size_t>(mean.size())});
  const auto draws = design::run_model(model, result.parameters, result.calibration.thinned.theta,
                                       context.executor);
  if (!draws) return tl::unexpected(draws.error());

  const std::size_t n = result.months.size();
  Rng rng{context.seed, kPredictiveStream};
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    OutputCalibration& output = result.outputs[k];
    const auto part = [&](const std::vector<double>& all) {
      return std::span{all}.subspan(k * n, n);
    };
    const Eigen::MatrixXd simulated =
        draws->middleCols(static_cast<Eigen::Index>(k * n), static_cast<Eigen::Index>(n));
    const Eigen::VectorXd spread = output.calibrated
                                       ? spread_sds(result.calibration, k, output.weight)
                                       : Eigen::VectorXd::Zero(simulated.rows()).eval();
    output.assessment =
        assessment::assess_output(output.measured, result.roles,
                                  {.prior_mode = part(at_mode),
                                   .prior_mean = part(at_mean),
                                   .posterior_mean = part(after),
                                   .draws = simulated,
                                   .predictive = assessment::add_discrepancy_and_error(
                                       simulated, spread, output.extra_variances, rng)});
  }
  return {};
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
  for (const calibration::Finding& finding : result.calibration.findings) {
    result.warnings.push_back(finding.sentence);
  }
  if (result.sensitivity) {
    for (const calibration::Finding& finding : result.sensitivity->findings) {
      result.warnings.push_back(finding.sentence);
    }
  }
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

Result<SiteCalibration> calibrate_site(const SiteConfig& site,
                                       const metering::LocalCalendar& calendar,
                                       const Recording& recording, const SiteWeather& weather,
                                       const CalibrateOptions& options,
                                       const calibration::RunContext& context) {
  SiteCalibration result;
  const Months months = choose_months(*site.period, weather, result.warnings);
  if (auto enough = require_months(months, *site.period, weather); !enough) {
    return tl::unexpected(enough.error());
  }
  result.months = months.all;
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
  EpcModel model{*site.building, result.definitions, *maps, *climate};
  const auto inputs = weather::monthly_inputs(weather.filled.series, calendar, months.calibration);
  auto problem = make_problem(result, inputs, months.calibration.size());
  problem.common_errors.push_back(heat_share_error(*site.building, model, result.definitions, *maps,
                                                   *climate,
                                                   prior_points(result.parameters, true)));

  auto design = calibration::run_design(model, problem, options.calibration.design_runs, context);
  if (!design) return tl::unexpected(design.error());
  set_aside_unresponsive(*design, result, problem);
  auto calibrated = calibration::calibrate_on_design(model, problem, options.calibration,
                                                     std::move(*design), context);
  if (!calibrated) return tl::unexpected(calibrated.error());
  result.calibration = std::move(*calibrated);
  if (options.prior_sensitivity) {
    auto sensitivity = calibration::prior_sensitivity(model, problem, options.calibration,
                                                      result.calibration, context);
    if (!sensitivity) return tl::unexpected(sensitivity.error());
    result.sensitivity = std::move(*sensitivity);
  }

  const auto whole_climate =
      model::epc::prepare_climate(months.all, *site.building, result.profile.loads, place);
  if (!whole_climate) return tl::unexpected(whole_climate.error());
  EpcModel whole{*site.building, result.definitions, *maps, *whole_climate};
  if (const auto assessed = assess(whole, context, result); !assessed) {
    return tl::unexpected(assessed.error());
  }
  add_words(recording, weather, result);
  return result;
}

}  // namespace recald::daemon
