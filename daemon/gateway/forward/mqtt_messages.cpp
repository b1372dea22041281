#include "daemon/gateway/forward/mqtt_messages.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "daemon/gateway/forward/outgoing_names.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"

namespace recald::daemon {
namespace {

mqtt::Message interval_message(const SiteConfig& site, const OutboxEntry& entry,
                               const StoredInterval& interval) {
  const OutgoingMeter meter = outgoing_meter(site, entry.meter);
  const bool is_weather = !meter.quantity.empty();
  return {.topic = is_weather ? fmt::format("{}/weather/{}/{}/interval", site_topic(site), meter.id,
                                            meter.quantity)
                              : fmt::format("{}/meter/{}/interval", site_topic(site), meter.id),
          .payload = is_weather ? weather_interval_json(interval)
                                : interval_json(interval, entry.interval)};
}

mqtt::Message month_message(const SiteConfig& site, const OutboxEntry& entry,
                            const metering::MonthlyFigure& figure) {
  return {.topic = fmt::format("{}/meter/{}/month/{}", site_topic(site), entry.meter,
                               metering::to_string(figure.month)),
          .payload = payload_of(month_json(entry.meter, figure)),
          .is_retained = true};
}

}  // namespace

std::string payload_of(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string site_topic(const SiteConfig& site) { return site.mqtt->topic + "/" + site.id; }

mqtt::Message presence_message(const SiteConfig& site, bool is_online) {
  return {.topic = site_topic(site) + "/status",
          .payload = is_online ? "online" : "offline",
          .is_retained = true};
}

std::vector<mqtt::Message> mqtt_messages(const SiteConfig& site, const OutgoingBatch& batch) {
  std::vector<mqtt::Message> messages;
  for (const OutboxEntry& entry : batch.entries) {
    if (const auto* const interval = std::get_if<StoredInterval>(&entry.stored)) {
      messages.push_back(interval_message(site, entry, *interval));
    } else if (const auto* const month = std::get_if<StoredMonth>(&entry.stored)) {
      messages.push_back(month_message(site, entry, month->figure));
    }
  }
  for (const StoreEvent& event : batch.events) {
    messages.push_back(
        {.topic = site_topic(site) + "/event", .payload = payload_of(event_json(event))});
  }
  return messages;
}

}  // namespace recald::daemon
