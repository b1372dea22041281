/// How an outbox entry is called outside.
#pragma once

#include <string>
#include <string_view>

#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// A meter of the store: a [[meter]], or one quantity of a weather sensor.
struct OutgoingMeter {
  std::string id;        ///< Of the [[meter]].
  std::string quantity;  ///< "dry_bulb_C" of a weather sensor; empty for a meter.
  std::string utility;   ///< "electricity"; empty where the site file no longer has the meter.
};

/// @param stored_id  As in the store: "main", "roof.dry_bulb_C".
[[nodiscard]] inline OutgoingMeter outgoing_meter(const SiteConfig& site,
                                                  std::string_view stored_id) {
  if (const auto index = site.meter_index(std::string{stored_id})) {
    return {.id = std::string{stored_id},
            .quantity = {},
            .utility = std::string{metering::to_string(site.meters[*index].meter.utility)}};
  }
  const std::size_t dot = stored_id.find('.');
  const std::string_view quantity =
      dot == std::string_view::npos ? std::string_view{} : stored_id.substr(dot + 1);
  return {.id = std::string{stored_id.substr(0, dot)},
          .quantity = std::string{quantity},
          .utility = {}};
}

}  // namespace recald::daemon
