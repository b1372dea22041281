#include "daemon/site/model/modelled_site.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "daemon/site/model/active_effects.hpp"
#include "daemon/site/model/energyplus_effects.hpp"
#include "daemon/site/model/site_parts.hpp"
#include "daemon/site/replay/stored_readings.hpp"

namespace recald::daemon {
namespace {

/// The meters to compare with: the model's outputs, or every meter if there is no model.
std::vector<std::string> outputs_of(const SiteConfig& site) {
  if (site.model) return site.model->outputs;
  std::vector<std::string> all;
  for (const MeterConfig& config : site.meters) all.push_back(config.meter.id);
  return all;
}

/// A gateway may read a thousand meters for a model of three. Only those are loaded from its store,
/// so a meter that was just added or reports nonsense does not affect the model.
void leave_out_unmodelled_live_meters(SiteConfig& site) {
  std::vector<std::string> needed = site.model->outputs;
  if (const auto electricity = profile_meter(site)) {
    needed.push_back(site.meters[*electricity].meter.id);
  }
  const std::vector<std::string> parts = site.without_sums(needed);
  needed.insert(needed.end(), parts.begin(), parts.end());
  std::vector<MeterConfig> kept;
  for (const MeterConfig& config : site.meters) {
    const bool is_needed = std::ranges::find(needed, config.meter.id) != needed.end();
    if (is_needed || !site.comes_from_store(config)) kept.push_back(config);
  }
  site.meters = std::move(kept);
}

/// @pre meters that the model does not use were removed
Result<void> require_live_months(const SiteConfig& site, const Recording& recording) {
  for (std::size_t i = 0; i < site.meters.size(); ++i) {
    const MeterConfig& config = site.meters[i];
    if (!site.comes_from_store(config) || !recording.meters[i].figures.empty()) continue;
    return failure(ErrorCode::not_enough_data,
                   fmt::format("the store has no closed month of meter '{}' yet, which the model "
                               "needs; the daemon closes a month some days after its end",
                               config.meter.id));
  }
  return {};
}

/// Null for a site without live meters or sensors.
Result<std::unique_ptr<StoredReadings>> open_live_readings(const SiteConfig& site) {
  if (!has_stored_meters(site)) return open_sensors(site);
  return StoredReadings::open(site);
}

}  // namespace

using metering::MonthRange;

MonthRange whole_period(const SiteConfig& site) {
  MonthRange whole = site.period->calibration;
  if (site.period->validation) {
    whole.first = std::min(whole.first, site.period->validation->first);
    whole.last = std::max(whole.last, site.period->validation->last);
  }
  return whole;
}

Result<void> require_model(const SiteConfig& site) {
  if (site.model) return {};
  return failure(
      ErrorCode::not_enough_data,
      fmt::format("{} describes meters but no [[model]]; add one with a [building] and a "
                  "[period] to calibrate, or a [weather] with the temperature, on which `recald "
                  "calibrate` forecasts meters without a model, or use `recald replay`",
                  site.file.filename().string()));
}

Result<void> choose_model(SiteConfig& site, ModelKind kind) {
  if (site.model->kind == kind) return {};
  const auto other = std::ranges::find(site.other_models, kind, &ModelConfig::kind);
  if (other != site.other_models.end()) {
    std::swap(*site.model, *other);
    return {};
  }
  const bool is_of_building = facts_of(kind).is_of_building;
  if (is_of_building && facts_of(site.model->kind).is_of_building) {
    site.model->kind = kind;
    return {};
  }
  const auto with_building = std::ranges::find_if(site.other_models, [](const ModelConfig& model) {
    return facts_of(model.kind).is_of_building;
  });
  if (is_of_building && with_building != site.other_models.end()) {
    std::swap(*site.model, *with_building);
    site.model->kind = kind;
    return {};
  }
  return failure(
      ErrorCode::unsupported,
      fmt::format("{} has no [[model]] of kind \"{}\"{}; add one", site.file.filename().string(),
                  name_of(kind), is_of_building ? ", which needs a [building]" : ""));
}

Result<Recording> record_site(const OpenSite& site, const ReplayOptions& options,
                              VirtualClock& clock, const OnMonthClosed& on_month_closed) {
  const auto live = TRY(open_live_readings(site.config));
  return replay_meters(site.config, site.calendar, options, clock, on_month_closed, live.get());
}

Result<ModelledSite> load_modelled_site(OpenSite site, metering::Instant now,
                                        const ChoosePeriod& choose) {
  if (site.config.model) leave_out_unmodelled_live_meters(site.config);
  if (site.config.model && site.config.model->energyplus) {
    const auto version = TRY(active_version(site.config));
    TRY(take_in_effects(version, *site.config.model));
  }
  VirtualClock clock{metering::Instant{}};
  auto recording = TRY(replay_meters(site.config, site.calendar, {}, clock, {}));
  auto live = TRY(open_live_readings(site.config));
  if (live) {
    TRY(take_closed_months(site.config, site.calendar, *live, recording));
  }
  if (site.config.model) {
    TRY(require_live_months(site.config, recording));
  }
  if (choose) {
    site.config.period = TRY(choose(site, recording, now));
  } else if (!site.config.period) {
    const auto months = TRY(latest_months(site, recording, now));
    site.config.period = PeriodConfig{months, {}};
  }
  if (live) {
    TRY(take_hours(site.config, site.calendar, whole_period(site.config), *live, recording));
  }
  auto weather =
      TRY(load_weather(site.config, site.calendar, whole_period(site.config), live.get()));
  auto facts = TRY(facts_of(site.config, live ? live->digest() : ""));
  facts.weather_values = to_string(weather.values);
  facts.weather = known_weather(weather);
  for (const std::size_t variable : weather.assumed) {
    facts.weather_assumed.emplace_back(weather::kWeatherVariables[variable].name);
  }
  return ModelledSite{std::move(site), std::move(recording), std::move(weather), std::move(facts)};
}

Result<MonthRange> latest_months(const OpenSite& site, const Recording& recording,
                                 metering::Instant now) {
  // A model needs months that all its meters have; without a model each meter stands alone.
  const bool is_shared = site.config.model.has_value();
  std::optional<MonthRange> common;
  for (const std::string& id : outputs_of(site.config)) {
    const MeterRecord& record = recording.meters[*site.config.meter_index(id)];
    const auto is_closed = [&](const metering::MonthlyFigure& figure) {
      return figure.usable &&
             site.calendar.month_span(figure.month).end + site.config.closing.watermark <= now;
    };
    const auto last = std::find_if(record.figures.rbegin(), record.figures.rend(), is_closed);
    if (last == record.figures.rend()) {
      if (!is_shared) continue;
      return failure(ErrorCode::not_enough_data,
                     fmt::format("meter '{}' has no usable closed month yet", id));
    }
    const MonthRange own{record.figures.front().month, last->month};
    if (!common) common = own;
    common->first = is_shared ? std::max(common->first, own.first)  //
                              : std::min(common->first, own.first);
    common->last = is_shared ? std::min(common->last, own.last)  //
                             : std::max(common->last, own.last);
  }
  if (!common) {
    return failure(ErrorCode::not_enough_data, "no meter has a usable closed month yet");
  }
  common->first = std::max(
      common->first, common->last - std::chrono::months{site.config.recalibration.months - 1});
  if (common->last < common->first) {
    return failure(ErrorCode::not_enough_data,
                   "the modelled meters have no closed month in common yet");
  }
  return *common;
}

}  // namespace recald::daemon
