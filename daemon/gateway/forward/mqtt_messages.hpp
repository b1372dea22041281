/// Intervals, months and events as messages for a broker.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "adapters/mqtt/message.hpp"
#include "daemon/gateway/forward/outbox/sink.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// As a payload: what is no UTF-8 in a text, such as a piece of a message, is replaced.
[[nodiscard]] std::string payload_of(const nlohmann::ordered_json& json);

/// "recald/tower-3", under which everything of the site is.
[[nodiscard]] std::string site_topic(const SiteConfig& site);

/// "online", said after each connect, or "offline", said by the broker when the connection breaks.
/// Retained.
[[nodiscard]] mqtt::Message presence_message(const SiteConfig& site, bool is_online);

/// Each as JSON, as the API has it. Months are retained, each under a topic of its own; intervals
/// and events are not, so that nobody takes an old one for a new one.
/// @pre the site has a [mqtt]
[[nodiscard]] std::vector<mqtt::Message> mqtt_messages(const SiteConfig& site,
                                                       const OutgoingBatch& batch);

}  // namespace recald::daemon
