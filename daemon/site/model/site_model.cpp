#include "daemon/site/model/site_model.hpp"

#include <algorithm>
#include <cassert>

#include "core/model/hourly/hourly_model.hpp"

namespace recald::daemon {
namespace {

using metering::Month;
using model::hourly::HourlyModel;
using Alterations = std::vector<std::shared_ptr<const model::hourly::Alteration>>;

std::vector<model::hourly::OutputDefinition> hourly_outputs(std::size_t meters) {
  std::vector<model::hourly::OutputDefinition> outputs;
  for (int meter = 0; meter < static_cast<int>(meters); ++meter) {
    outputs.push_back({meter, model::hourly::OutputKind::daily_kWh});
    outputs.push_back({meter, model::hourly::OutputKind::peak_kW});
  }
  return outputs;
}

/// The effects, restricted to these months of their site.
std::vector<diagnosis::MonthlyEffect> effects_in(const SiteModelParts& parts,
                                                 const std::vector<Month>& months) {
  if (!parts.effects) return {};
  const std::vector<Month>& known = parts.effects->site->drivers->months;
  std::vector<int> places;
  for (const Month month : months) {
    const auto found = std::ranges::find(known, month);
    assert(found != known.end());
    places.push_back(static_cast<int>(found - known.begin()));
  }
  std::vector<diagnosis::MonthlyEffect> effects;
  for (const diagnosis::MonthlyEffect& effect : parts.monthly) {
    effects.push_back(effect.in_months(places));
  }
  return effects;
}

Result<ModelFactory> monthly_model(const SiteConfig& site, const SiteModelParts& parts,
                                   const std::vector<Month>& months,
                                   const model::epc::Place& place) {
  auto climate = model::epc::prepare_climate(months, *site.building, parts.loads, place);
  if (!climate) return tl::unexpected(climate.error());
  return [parts, effects = effects_in(parts, months), climate = std::move(*climate)](
             const model::Building& building) -> std::unique_ptr<MonthlyModel> {
    auto epc =
        std::make_unique<model::epc::EpcModel>(building, parts.definitions, parts.maps, climate);
    if (!parts.effects) return epc;
    return std::make_unique<diagnosis::AlteredMonthlyModel>(std::move(epc), effects);
  };
}

/// Effects count days from the first hour of the site to which they were bound.
void count_days_from(const model::Drivers& first, model::Drivers& drivers) {
  const std::chrono::sys_days origin{first.hours.front().date};
  for (model::DriverHour& hour : drivers.hours) {
    hour.day_index = static_cast<int>((std::chrono::sys_days{hour.date} - origin).count());
  }
}

Result<ModelFactory> hourly_model(const SiteConfig& site, const SiteModelParts& parts,
                                  const std::vector<Month>& months,
                                  const model::epc::Place& place) {
  auto made = TRY(model::make_drivers(months, place.calendar, place.holidays, *site.building,
                                      parts.loads, place.location, place.weather));
  if (parts.effects) count_days_from(*parts.effects->site->drivers, made);
  // Peaks are means over the meters' interval, so the model's steps must not be longer.
  const int steps = site.interval < std::chrono::hours{1} ? 4 : 1;
  return [parts, steps, drivers = std::make_shared<const model::Drivers>(std::move(made))](
             const model::Building& building) -> std::unique_ptr<MonthlyModel> {
    const auto with = [=](Alterations alterations) -> std::unique_ptr<MonthlyModel> {
      return std::make_unique<HourlyModel>(
          building, parts.definitions, parts.maps, hourly_outputs(parts.maps.size()), drivers,
          model::hourly::HourlyOptions{.steps_per_hour = steps}, std::move(alterations));
    };
    if (!parts.effects) return with({});
    return std::make_unique<diagnosis::AlteredHourlyModel>(with, parts.effects);
  };
}

}  // namespace

bool is_hourly(const SiteConfig& site) {
  return site.model && site.model->kind == ModelKind::hourly;
}

Result<ModelFactory> model_of(const SiteConfig& site, const SiteModelParts& parts,
                              const std::vector<Month>& months, const model::epc::Place& place) {
  return is_hourly(site) ? hourly_model(site, parts, months, place)
                         : monthly_model(site, parts, months, place);
}

}  // namespace recald::daemon
