/// Delivers an alert by mail or to a web address.
#pragma once

#include "daemon/gateway/alert/alerts.hpp"

namespace recald::daemon {

/// A `Deliver`. Secrets are read from their files each time, so that they can be renewed.
/// @return or why not: as `delivery::post_json`, `delivery::send_mail`, or a secret's file.
[[nodiscard]] Result<void> deliver(const AlertDestination& destination, const AlertMessage& message,
                                   const std::stop_token& stop);

}  // namespace recald::daemon
