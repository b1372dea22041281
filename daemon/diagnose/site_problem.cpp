#include "daemon/diagnose/site_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/model/hourly/prepare.hpp"
#include "daemon/calibrate/assessed_calibration.hpp"
#include "daemon/calibrate/site_calibration.hpp"

namespace recald::daemon {
namespace {

using diagnosis::SiteProblem;
using metering::Month;

constexpr std::size_t kLeastMonths = 6;
constexpr double kLeastWeatherCoverage = 0.5;
constexpr double kLeastOkShare = 0.5;

/// What day parts can inform besides the parameters that the site file names.
constexpr std::array<std::string_view, 14> kDayPartParameters = {
    "start_early",         "stop_late",        "occupancy_density",  "outdoor_airflow",
    "cooling_setpoint",    "heating_setpoint", "u_factor_scale",     "shgc_scale",
    "specific_heat_scale", "leakage_area",     "supply_temperature", "minimum_supply_flow",
    "hot_water_volume",    "base_heat"};

std::vector<Month> months_of(const PeriodConfig& period, const SiteWeather& weather) {
  std::vector<Month> months;
  const auto take = [&](const metering::MonthRange& range) {
    for (Month month = range.first; month <= range.last; month = metering::next_month(month)) {
      if (weather_coverage(weather.filled, month) >= kLeastWeatherCoverage) months.push_back(month);
    }
  };
  take(period.calibration);
  if (period.validation) take(*period.validation);
  std::ranges::sort(months);
  const auto repeated = std::ranges::unique(months);
  months.erase(repeated.begin(), repeated.end());
  return months;
}

const MeterRecord* electricity_of(const Recording& recording) {
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

Result<void> choose_parameters(const SiteConfig& site, SiteProblem& problem) {
  const auto add = [&](std::string_view name, const std::optional<Prior>& prior) -> Result<void> {
    const auto definition = model::find_parameter(name);
    if (!definition) return tl::unexpected(definition.error());
    auto parameter = model::make_parameter(**definition, *site.building, prior);
    if (!parameter) return tl::unexpected(parameter.error());
    problem.definitions.push_back(*definition);
    problem.parameters.push_back(std::move(*parameter));
    return {};
  };
  for (const ParameterConfig& config : site.model->parameters) {
    if (auto added = add(config.name, config.prior); !added) return added;
  }
  for (const std::string_view name : kDayPartParameters) {
    if (std::ranges::find(problem.parameters, name, &Parameter::name) != problem.parameters.end()) {
      continue;
    }
    // A design value of 0 or outside the library's range: the drawings are taken at their word.
    (void)add(name, {});
  }
  return {};
}

}  // namespace

Result<SiteProblem> make_site_problem(const SiteConfig& site,
                                      const metering::LocalCalendar& calendar,
                                      const Recording& recording, const SiteWeather& weather) {
  SiteProblem problem;
  problem.nominal = *site.building;
  const std::vector<Month> months = months_of(*site.period, weather);
  if (months.size() < kLeastMonths) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("a diagnosis needs at least {} months with weather and meters; {} "
                               "has {}; widen [period] or give more weather",
                               kLeastMonths, site.id, months.size()));
  }
  const MeterRecord* electricity = electricity_of(recording);
  if (electricity == nullptr) {
    return failure(ErrorCode::not_enough_data,
                   "the model takes lights and plugs from an electricity meter, and the site has "
                   "none; add a [[meter]] with utility = \"electricity\"");
  }
  const model::epc::Place place{calendar, site.holidays, *site.location, weather.filled.series};
  auto profile = model::hourly::fit_profile_without_plant(loads_of(*electricity, months),
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
  if (auto chosen = choose_parameters(site, problem); !chosen) {
    return tl::unexpected(chosen.error());
  }
  problem.day_parts = diagnosis::make_day_parts(*problem.drivers);
  problem.measured_parts_kW = diagnosis::measured_parts(problem.day_parts, problem.measured_kW);
  const diagnosis::SplitOptions split;
  problem.month_roles = diagnosis::split_months(months, split);
  problem.roles = diagnosis::part_roles(problem.day_parts, problem.month_roles, split.buffer_days);
  return problem;
}

}  // namespace recald::daemon
