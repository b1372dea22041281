/// `recald check --alerts`: whether a message reaches each destination.
#pragma once

#include "daemon/commands/console.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Sends a trial message to each destination of [alerts].
/// @param is_quiet  Prints nothing.
/// @return a problem for each that does not take it, or one if there is nobody to tell.
[[nodiscard]] std::vector<std::string> try_alerts(const SiteConfig& site, const Console& console,
                                                  bool is_quiet);

}  // namespace recald::daemon
