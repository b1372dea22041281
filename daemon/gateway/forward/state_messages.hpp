/// The state of a site and its meters for a broker, and what Home Assistant makes of it.
#pragma once

#include <vector>

#include "adapters/mqtt/message.hpp"
#include "daemon/gateway/registers/register_facts.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// "recald/SITE/state" and "recald/SITE/meter/METER/state": what the registers of a management
/// system have, as JSON. Retained.
/// @pre the site has a [mqtt]; facts.meters are its meters
[[nodiscard]] std::vector<mqtt::Message> state_messages(const SiteConfig& site,
                                                        const SiteFacts& facts);

/// The entities that Home Assistant shows, retained under its discovery prefix; none without one.
/// https://www.home-assistant.io/integrations/mqtt/#mqtt-discovery
[[nodiscard]] std::vector<mqtt::Message> discovery_messages(const SiteConfig& site);

}  // namespace recald::daemon
