#include "daemon/diagnose/site_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/model/hourly/prepare.hpp"
#include "daemon/calibrate/assessed_calibration.hpp"
#include "daemon/calibrate/site_parts.hpp"

namespace recald::daemon {
namespace {

using diagnosis::SiteProblem;
using metering::Month;

constexpr std::size_t kLeastMonths = 6;
constexpr double kLeastOkShare = 0.5;

/// What day parts can inform besides the parameters that the site file names. Where drawings may be
/// wrong by a factor the prior is log-normal about them, wider than the library's range: a
/// diagnosis must not take a misremembered number for an effect.
struct DayPartParameter {
  std::string_view name;
  double log_sd = 0.0;  ///< 0: the library's prior.
};
constexpr auto kDayPartParameters = std::to_array<DayPartParameter>({
    {"start_early"},           {"stop_late"},          {"occupancy_density", 0.5},
    {"outdoor_airflow", 0.4},  {"cooling_setpoint"},   {"heating_setpoint"},
    {"u_factor_scale", 0.3},   {"shgc_scale", 0.4},    {"specific_heat_scale", 0.6},
    {"leakage_area", 0.7},     {"supply_temperature"}, {"minimum_supply_flow", 0.35},
    {"hot_water_volume", 0.6}, {"base_heat", 0.7},     {"closet_share"},
    {"gains_to_core"},         {"supply_reset"},       {"warm_up"},
    {"closed_start"},
});

/// Measured hours of one meter in the order of the drivers; NaN where not measured. The hour that
/// the clock repeats in autumn is recorded once and stands twice.
Eigen::ArrayXd hours_of(const MeterRecord& record, const model::Drivers& drivers) {
  std::map<std::pair<metering::Day, int>, double> by_hour;
  for (const auto& [month, hours] : record.hours) {
    for (const profile::HourlyLoad& hour : hours) {
      if (hour.ok_share >= kLeastOkShare) by_hour[{hour.date, hour.hour}] = hour.mean_kW;
    }
  }
  Eigen::ArrayXd values(static_cast<Eigen::Index>(drivers.hours.size()));
  for (std::size_t i = 0; i < drivers.hours.size(); ++i) {
    const auto found = by_hour.find({drivers.hours[i].date, drivers.hours[i].local_hour});
    values[static_cast<Eigen::Index>(i)] = found == by_hour.end() ? kAbsent : found->second;
  }
  return values;
}

/// The prior of a diagnosis; absent: the library's.
std::optional<Prior> wide_prior(const DayPartParameter& parameter, const model::Building& nominal) {
  if (parameter.log_sd == 0.0) return std::nullopt;
  const auto definition = model::find_parameter(parameter.name);
  const double drawn = definition ? (*definition)->get(nominal) : 0.0;
  if (!(drawn > 0.0)) return std::nullopt;
  return Prior{LogNormalPrior{.median = drawn, .log_sd = parameter.log_sd}};
}

/// Those of the site file, and what else day parts can inform. A prior that the file gives stands.
Result<ChosenParameters> choose_parameters(const SiteConfig& site) {
  ChosenParameters chosen;
  for (const ParameterConfig& config : site.model->parameters) {
    const auto wide = std::ranges::find(kDayPartParameters, config.name, &DayPartParameter::name);
    const bool widen = !config.prior && wide != kDayPartParameters.end();
    const auto prior = widen ? wide_prior(*wide, *site.building) : config.prior;
    if (auto added = chosen.add(config.name, *site.building, prior); !added) {
      return tl::unexpected(added.error());
    }
  }
  for (const DayPartParameter& parameter : kDayPartParameters) {
    if (std::ranges::find(chosen.parameters, parameter.name, &Parameter::name) !=
        chosen.parameters.end()) {
      continue;
    }
    // A design value of 0 or outside the library's range: the drawings are taken at their word.
    (void)chosen.add(parameter.name, *site.building, wide_prior(parameter, *site.building));
  }
  return chosen;
}

}  // namespace

Result<SiteProblem> make_site_problem(const SiteConfig& site,
                                      const metering::LocalCalendar& calendar,
                                      const Recording& recording, const SiteWeather& weather) {
  SiteProblem problem;
  problem.nominal = *site.building;
  std::vector<std::string> said_by_calibrations;
  const std::vector<Month> months =
      choose_months(*site.period, weather, said_by_calibrations).in_order();
  if (months.size() < kLeastMonths) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("a diagnosis needs at least {} months with weather and meters; {} "
                               "has {}; widen [period] or give more weather",
                               kLeastMonths, site.id, months.size()));
  }
  const auto electricity = electricity_meter(recording);
  if (!electricity) return tl::unexpected(electricity.error());
  const model::epc::Place place{calendar, site.holidays, *site.location, weather.filled.series};
  const diagnosis::SplitOptions split;
  problem.month_roles = diagnosis::split_months(months, split);
  // The months to be shown must not tell their own electricity.
  std::vector<Month> told;
  for (std::size_t i = 0; i < months.size(); ++i) {
    if (problem.month_roles[i] != diagnosis::Role::show) told.push_back(months[i]);
  }
  auto profile = model::hourly::fit_profile_without_plant(loads_of(**electricity, told),
                                                          *site.building, place, months);
  if (!profile) return tl::unexpected(profile.error());
  // One profile for all months: factors of calendar months would hide what a diagnosis looks for.
  profile->loads.month_factor.fill(1.0);

  auto drivers =
      model::make_drivers(months, calendar, site.holidays, *site.building, profile->loads,
                          *site.location, weather.filled.series, model::MissingWeather::assume);
  if (!drivers) return tl::unexpected(drivers.error());
  problem.drivers = std::make_shared<const model::Drivers>(std::move(*drivers));

  const auto maps = meter_maps(site);
  if (!maps) return tl::unexpected(maps.error());
  problem.measured_kW.resize(static_cast<Eigen::Index>(problem.drivers->hours.size()),
                             static_cast<Eigen::Index>(maps->size()));
  for (std::size_t k = 0; k < maps->size(); ++k) {
    const std::string& id = site.model->outputs[k];
    const std::size_t meter = *site.meter_index(id);
    problem.meters.push_back({id, site.meters[meter].meter.utility, (*maps)[k]});
    problem.measured_kW.col(static_cast<Eigen::Index>(k)) =
        hours_of(recording.meters[meter], *problem.drivers);
  }
  auto chosen = choose_parameters(site);
  if (!chosen) return tl::unexpected(chosen.error());
  problem.definitions = std::move(chosen->definitions);
  problem.parameters = std::move(chosen->parameters);
  problem.day_parts = diagnosis::make_day_parts(*problem.drivers);
  problem.measured_parts_kW = diagnosis::measured_parts(problem.day_parts, problem.measured_kW);
  problem.roles = diagnosis::part_roles(problem.day_parts, problem.month_roles, split.buffer_days);
  return problem;
}

}  // namespace recald::daemon
