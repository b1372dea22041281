#include "daemon/site/model/diagnosis_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "core/absent.hpp"
#include "core/assessment/assessed_calibration.hpp"
#include "core/diagnosis/evidence/day_part_parameters.hpp"
#include "core/display/id_words.hpp"
#include "core/display/warning.hpp"
#include "core/model/hourly/prepare.hpp"
#include "daemon/site/model/meter_rates.hpp"
#include "daemon/site/model/site_parts.hpp"

namespace recald::daemon {
namespace {

using diagnosis::SiteProblem;
using metering::Month;

constexpr std::size_t kLeastMonths = 6;
constexpr double kLeastOkShare = 0.5;
constexpr double kLeastReadShare = 0.5;  // of a month's hours, for the month to count as read
// Indices in `weather::kWeatherVariables`.
constexpr std::size_t kHumidity = 1;
constexpr std::size_t kWind = 2;
constexpr std::size_t kSun = 4;

/// Months of the period with weather, ascending.
std::vector<Month> months_with_weather(const SiteConfig& site, const SiteWeather& weather,
                                       display::Warnings& warnings) {
  return choose_months(*site.period, weather, warnings).in_order();
}

bool is_read(const MeterRecord& record, Month month) {
  const auto found = record.hours.find(month);
  if (found == record.hours.end()) return false;
  const auto read = std::ranges::count_if(
      found->second, [](const model::HourlyLoad& hour) { return hour.ok_share >= kLeastOkShare; });
  return static_cast<double>(read) >= kLeastReadShare * 24.0 * metering::days_in(month);
}

/// The months in which some meter of the model was read.
std::vector<Month> months_read(const SiteConfig& site, const Recording& recording,
                               const std::vector<Month>& months) {
  std::vector<Month> read;
  std::ranges::copy_if(months, std::back_inserter(read), [&](Month month) {
    return std::ranges::any_of(site.model->outputs, [&](const std::string& id) {
      return is_read(recording.meters[*site.meter_index(id)], month);
    });
  });
  return read;
}

/// Measured hours of one meter in the order of the drivers; NaN if not measured. The hour that the
/// clock repeats in autumn is recorded once and appears twice.
Eigen::ArrayXd hours_of(const MeterRecord& record, const model::Drivers& drivers) {
  std::map<std::pair<metering::Day, int>, double> by_hour;
  for (const auto& [month, hours] : record.hours) {
    for (const model::HourlyLoad& hour : hours) {
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

/// @param meter  Index among the site's meters.
diagnosis::MeterData priced(const SiteConfig& site, std::size_t meter, const MeterRecord& record,
                            const model::MeterMap& end_uses) {
  const metering::Meter& described = site.meters[meter].meter;
  const tariff::Rates rates = rates_of(site, record);
  return {.id = described.id,
          .utility = described.utility,
          .end_uses = end_uses,
          .price_per_kWh = rates.per_kWh,
          .emissions_kg_per_kWh = rates.emissions_kg_per_kWh};
}

/// The parameters of the site file, plus others that day parts can inform. Priors from
/// the file are kept.
Result<std::vector<Parameter>> choose_parameters(const SiteConfig& site) {
  std::vector<Parameter> chosen;
  const auto add = [&](std::string_view name, const std::optional<Prior>& prior) -> Result<void> {
    const auto definition = TRY(model::find_parameter(name));
    auto parameter = TRY(model::make_parameter(
        *definition, *site.building, prior ? prior : diagnosis::wide_prior(name, *site.building)));
    chosen.push_back(std::move(parameter));
    return {};
  };
  for (const ParameterConfig& config : site.model->parameters) {
    TRY(add(config.name, config.prior));
  }
  for (const std::string_view name : diagnosis::day_part_parameters(*site.building)) {
    if (std::ranges::find(chosen, name, &Parameter::name) != chosen.end()) continue;
    // If the design value is 0 or outside the library's range, the drawings are trusted.
    (void)add(name, {});
  }
  return chosen;
}

/// "2021-03 to 2021-05", in order of time.
std::string span_words(const std::vector<Month>& months) {
  if (months.size() == 1) return metering::to_string(months.front());
  return metering::to_string(months.front()) + " to " + metering::to_string(months.back());
}

Result<void> require_building_and_months(const SiteConfig& site, std::size_t months) {
  if (!site.building) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("{} has no [building], which hours are simulated with",
                               site.file.filename().string()));
  }
  if (months >= kLeastMonths) return {};
  return failure(ErrorCode::not_enough_data,
                 fmt::format("a diagnosis needs at least {} months with weather and meters; {} has "
                             "{}; widen [period] or give more weather",
                             kLeastMonths, site.id, months));
}

}  // namespace

Result<void> require_months(const SiteConfig& site, const Recording& recording,
                            const SiteWeather& weather) {
  display::Warnings warnings;
  const std::vector<Month> months = months_with_weather(site, weather, warnings);
  const std::vector<Month> read = months_read(site, recording, months);
  if (read.size() >= kLeastMonths) return {};
  std::string missing = "widen [period]";
  const auto first = std::ranges::find_if(warnings, [](const display::Warning& warning) {
    return warning.sentence.find(" left out") != std::string::npos;
  });
  if (months.size() < kLeastMonths && first != warnings.end()) {
    missing = "give more weather: " + first->sentence.substr(0, first->sentence.size() - 1);
  } else if (read.size() < months.size()) {
    missing = fmt::format("give more readings: those of {} cover {} with half of their hours",
                          site.id, read.empty() ? "no month" : span_words(read));
  }
  return failure(ErrorCode::not_enough_data,
                 fmt::format("a diagnosis needs at least {} months with weather and readings; {} "
                             "has {}; {}",
                             kLeastMonths, site.id, read.size(), missing));
}

display::Warnings data_warnings(const SiteConfig& site, const Recording& recording,
                                const SiteWeather& weather) {
  display::Warnings warnings;
  display::add_notes(recording.notes, warnings);
  display::add_notes(weather.notes, warnings);
  const std::vector<Month> months = months_with_weather(site, weather, warnings);
  for (const auto& [variable, name] :
       {std::pair{kHumidity, "humidity"}, std::pair{kWind, "wind"}, std::pair{kSun, "sun"}}) {
    if (!is_assumed(weather, variable)) continue;
    warnings.push_back({fmt::format(
        "The weather has no {}: it was assumed, and effects that need it cannot be named here.",
        name)});
  }
  for (const std::string& id : site.model->outputs) {
    const MeterRecord& record = recording.meters[*site.meter_index(id)];
    const auto read = static_cast<std::size_t>(
        std::ranges::count_if(months, [&](Month month) { return is_read(record, month); }));
    if (read >= kLeastMonths) continue;
    warnings.push_back(
        {.sentence = fmt::format("{}: only {} of {} months were read, and a diagnosis needs {}.",
                                 display::meter_label(id), read, months.size(), kLeastMonths),
         .details = "What is missing from the model there may go unseen; give more readings.",
         .share = static_cast<double>(months.size() - read) /
                  static_cast<double>(std::max<std::size_t>(months.size(), 1))});
  }
  return warnings;
}

Result<SiteProblem> make_site_problem(const SiteConfig& site,
                                      const metering::LocalCalendar& calendar,
                                      const Recording& recording, const SiteWeather& weather,
                                      std::optional<Month> last_taught) {
  display::Warnings reported_elsewhere;
  const std::vector<Month> months = months_with_weather(site, weather, reported_elsewhere);
  TRY(require_building_and_months(site, months.size()));
  SiteProblem problem;
  problem.nominal = *site.building;
  const auto electricity = TRY(electricity_meter(site, recording));
  const model::epc::Place place{calendar, site.holidays, *site.location, weather.filled.series};
  const diagnosis::SplitOptions split;
  problem.month_roles =
      diagnosis::split_months(months, months_read(site, recording, months), split);
  // Months to be shown must not contribute to their own electricity profile.
  std::vector<Month> metered;
  for (std::size_t i = 0; i < months.size(); ++i) {
    const bool is_metered =
        last_taught ? months[i] <= *last_taught : problem.month_roles[i] != diagnosis::Role::show;
    if (is_metered) metered.push_back(months[i]);
  }
  auto profile = TRY(model::hourly::fit_profile_without_plant(loads_of(*electricity, metered),
                                                              *site.building, place, months));
  // One profile for all months: factors of calendar months would hide what a
  // diagnosis searches for.
  profile.loads.month_factor.fill(1.0);

  auto drivers = TRY(model::make_drivers(months, calendar, site.holidays, *site.building,
                                         profile.loads, *site.location, weather.filled.series,
                                         model::MissingWeather::assume));
  drivers.has_humidity = drivers.has_humidity && !is_assumed(weather, kHumidity);
  drivers.has_wind = drivers.has_wind && !is_assumed(weather, kWind);
  problem.has_sun = !is_assumed(weather, kSun);
  problem.loads = profile.loads;
  problem.drivers = std::make_shared<const model::Drivers>(std::move(drivers));

  const auto maps = TRY(meter_maps(site));
  problem.measured_kW.resize(static_cast<Eigen::Index>(problem.drivers->hours.size()),
                             static_cast<Eigen::Index>(maps.size()));
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const std::string& id = site.model->outputs[k];
    const std::size_t meter = *site.meter_index(id);
    problem.meters.push_back(priced(site, meter, recording.meters[meter], maps[k]));
    problem.measured_kW.col(static_cast<Eigen::Index>(k)) =
        hours_of(recording.meters[meter], *problem.drivers);
  }
  problem.currency = site.tariff.currency;
  problem.units = site.units;
  problem.parameters = TRY(choose_parameters(site));
  problem.day_parts = diagnosis::make_day_parts(*problem.drivers);
  problem.measured_parts_kW = diagnosis::measured_parts(problem.day_parts, problem.measured_kW);
  problem.roles = diagnosis::part_roles(problem.day_parts, problem.month_roles, split.buffer_days);
  return problem;
}

}  // namespace recald::daemon
