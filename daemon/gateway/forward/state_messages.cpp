#include "daemon/gateway/forward/state_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/gateway/forward/mqtt_messages.hpp"
#include "daemon/gateway/registers/register_page.hpp"
#include "daemon/gateway/registers/register_table.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// Of the map, or new with every renewal.
constexpr std::array<std::string_view, 4> kOfNoUse{"map_version", "meters", "uptime", "time"};

/// "power_kW", "month_daily_average_kWh"
std::string key_of(std::string_view name, std::string_view unit) {
  if (unit.empty() || unit == "1") return std::string{name};
  return fmt::format("{}_{}", name, unit.substr(0, unit.find('/')));
}

/// Codes in words.
template <class Facts>
Json value_of(const RegisterEntry<Facts>& entry, const Facts& facts) {
  const double value = entry.value(facts);
  if (!std::isfinite(value)) return nullptr;
  const auto word = std::ranges::find(entry.words, static_cast<int>(value), &RegisterWord::number);
  if (word != entry.words.end()) return std::string{word->words};
  if (entry.type == RegisterType::f32) return value;
  return static_cast<std::int64_t>(value);
}

template <class Facts>
Json state_of(std::span<const RegisterEntry<Facts>> entries, const Facts& facts) {
  Json json;
  for (const RegisterEntry<Facts>& entry : entries) {
    if (std::ranges::find(kOfNoUse, entry.name) != kOfNoUse.end()) continue;
    json[key_of(entry.name, entry.unit)] = value_of(entry, facts);
  }
  json["alarm"] = words_of(facts.drift.alarm);
  return json;
}

std::string meter_topic(const SiteConfig& site, const std::string& meter) {
  return fmt::format("{}/meter/{}/state", site_topic(site), meter);
}

struct Entity {
  std::string_view key;  ///< In the state.
  std::string_view name;
  std::string_view unit;
  std::string_view device_class;
  std::string_view state_class;
};

constexpr std::array kSiteEntities{
    Entity{"quality", "data quality", "", "", ""},
    Entity{"drift_state", "drift", "", "", ""},
    Entity{"alarm", "likely cause of the alarm", "", "", ""},
    Entity{"meters_silent", "silent meters", "", "", "measurement"},
    Entity{"model_age_d", "age of the model", "d", "duration", "measurement"},
};
constexpr std::array kMeterEntities{
    Entity{"power_kW", "power", "kW", "power", "measurement"},
    Entity{"register_kWh", "energy", "kWh", "energy", "total_increasing"},
    Entity{"interval_mean_kW", "mean of the last interval", "kW", "power", "measurement"},
    Entity{"expected_q50_kW", "expected power", "kW", "power", "measurement"},
    Entity{"month_daily_average_kWh", "this month, kWh a day", "", "", "measurement"},
    Entity{"month_forecast_q50_kWh", "forecast of this month, kWh a day", "", "", "measurement"},
    Entity{"drift_state", "drift", "", "", ""},
};

/// An entity of one of the site's devices. @param id  Of the device, which is unique.
mqtt::Message sensor_message(const SiteConfig& site, const Entity& entity, const std::string& id,
                             const std::string& state_topic, const Json& device) {
  Json json = {{"name", entity.name},
               {"unique_id", fmt::format("{}_{}", id, entity.key)},
               {"state_topic", state_topic},
               {"value_template", fmt::format("{{{{ value_json.{} }}}}", entity.key)},
               {"availability_topic", site_topic(site) + "/status"},
               {"device", device},
               {"origin", {{"name", "recald"}, {"sw_version", kVersion}}}};
  if (!entity.unit.empty()) json["unit_of_measurement"] = entity.unit;
  if (!entity.device_class.empty()) json["device_class"] = entity.device_class;
  if (!entity.state_class.empty()) json["state_class"] = entity.state_class;
  return {.topic = fmt::format("{}/sensor/{}/{}/config", site.mqtt->home_assistant, id, entity.key),
          .payload = payload_of(json),
          .is_retained = true};
}

}  // namespace

std::vector<mqtt::Message> state_messages(const SiteConfig& site, const SiteFacts& facts) {
  std::vector<mqtt::Message> messages;
  Json state = state_of(site_registers(), facts);
  messages.push_back(
      {.topic = site_topic(site) + "/state", .payload = payload_of(state), .is_retained = true});
  for (std::size_t i = 0; i < facts.meters.size(); ++i) {
    const MeterFacts& meter = facts.meters[i];
    Json json = state_of(meter_registers(), meter);
    json["register_kWh"] = std::isfinite(meter.register_kWh) ? Json(meter.register_kWh) : Json();
    messages.push_back({.topic = meter_topic(site, site.meters[i].meter.id),
                        .payload = payload_of(json),
                        .is_retained = true});
  }
  return messages;
}

std::vector<mqtt::Message> discovery_messages(const SiteConfig& site) {
  std::vector<mqtt::Message> messages;
  if (site.mqtt->home_assistant.empty()) return messages;
  const std::string site_id = "recald_" + site.id;
  const Json site_device = {{"identifiers", {site_id}},
                            {"name", site.name.empty() ? site.id : site.name},
                            {"manufacturer", "recald"},
                            {"model", "building"},
                            {"sw_version", kVersion}};
  for (const Entity& entity : kSiteEntities) {
    messages.push_back(
        sensor_message(site, entity, site_id, site_topic(site) + "/state", site_device));
  }
  for (const MeterConfig& meter : site.meters) {
    const std::string id = fmt::format("{}_{}", site_id, meter.meter.id);
    const Json device = {{"identifiers", {id}},
                         {"name", meter.meter.id},
                         {"model", metering::to_string(meter.meter.utility)},
                         {"via_device", site_id}};
    for (const Entity& entity : kMeterEntities) {
      messages.push_back(
          sensor_message(site, entity, id, meter_topic(site, meter.meter.id), device));
    }
  }
  return messages;
}

}  // namespace recald::daemon
