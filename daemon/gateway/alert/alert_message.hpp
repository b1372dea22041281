/// What a destination is sent: one message about everything new, as text and as JSON.
#pragma once

#include <span>
#include <string>

#include "adapters/ports/store.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

struct AlertMessage {
  std::string id;        ///< The same for the same events.
  std::string subject;   ///< "Depot: a meter is silent"
  std::string text;      ///< For a person.
  std::string document;  ///< JSON; daemon/gateway/alert/README.md describes it.
  metering::Instant time;
};

/// @param events  In order of time, at least one; each of a kind in alert_kinds.hpp.
[[nodiscard]] AlertMessage alert_message(const SiteConfig& site,
                                         const metering::LocalCalendar& calendar,
                                         std::span<const StoreEvent> events, metering::Instant now);

/// What `recald check --alerts` sends to try the destinations.
[[nodiscard]] AlertMessage trial_message(const SiteConfig& site, metering::Instant now);

}  // namespace recald::daemon
